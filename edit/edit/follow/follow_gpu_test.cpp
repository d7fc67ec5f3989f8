// SPDX-License-Identifier: MIT
// A picture that goes on while its Composer follows a look.

#include "compose/test_stacks/host.hpp"
#include "edit/edits.hpp"

namespace darkroom::edit {
namespace {

using darkroom::test::Host;
using darkroom::test::must;

class ComposeFollow : public darkroom::test::StackTest {
  protected:
    static Look stack(const std::string& text) { return must(parse_look(text, "a.toml")); }
    static std::vector<std::uint32_t> word(float value) { return {std::bit_cast<std::uint32_t>(value)}; }
    /// The picture of a Composer that was filled with the look at once.
    static ReferenceImage fresh(const Host& host, const Look& look) {
        Composer composer(host.device);
        must(apply(look, composer));
        (void)must(composer.compile(host.compile_desc()));
        return host.run(composer);
    }
};

// An entry with passes that was compiled in full refuses to fade: that is wired anew.
TEST_F(ComposeFollow, ValuesAreSeenAtOnceAndTheRestAfterACompile) {
    const Host host(darkroom::test::round_to_float(darkroom::test::random_display(40, 33, 3)));
    const Look was = stack("[[stack]]\neffect = \"exposure\"\n[[stack]]\neffect = \"gaussian_blur\"\nradius = 3\n");
    Composer composer(host.device);
    must(apply(was, composer));
    (void)must(composer.compile(host.compile_desc()));
    const ReferenceImage before = host.run(composer);

    Look bright = was;
    must(set_value(bright, "exposure", "exposure", word(0.5f)));
    EXPECT_FALSE(must(follow(was, bright, composer)).needs_compile);
    EXPECT_EQ(darkroom::test::worst_difference(host.run(composer), fresh(host, bright)), 0);

    Look faded = bright;
    must(set_state(faded, "gaussian_blur", "opacity", word(0.25f)));
    const ReferenceImage full = host.run(composer);
    EXPECT_TRUE(must(follow(bright, faded, composer)).needs_compile);
    EXPECT_EQ(darkroom::test::worst_difference(host.run(composer), full), 0) << "the plan goes on";
    (void)must(composer.compile(host.compile_desc()));
    EXPECT_EQ(darkroom::test::worst_difference(host.run(composer), fresh(host, faded)), 0);
    EXPECT_GT(darkroom::test::worst_difference(host.run(composer), full), 0.01);

    EXPECT_FALSE(must(follow(faded, was, composer)).needs_compile);
    EXPECT_EQ(darkroom::test::worst_difference(host.run(composer), before), 0);
}

}  // namespace
}  // namespace darkroom::edit
