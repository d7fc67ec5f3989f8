// SPDX-License-Identifier: MIT
// An opacity that is accepted is seen, by whichever plan the next recordings use.

#include "compose/test_stacks/host.hpp"

namespace darkroom {
namespace {

using test::add;
using test::Host;

class ComposeOpacity : public test::StackTest {};

/// Black beside white: a blur makes it grey along the edge.
ReferenceImage black_beside_white() {
    ReferenceImage out = test::uniform(32, 8, {0, 0, 0, 1});
    for (std::uint32_t y = 0; y < out.height; ++y)
        for (std::uint32_t x = 16; x < out.width; ++x) out.at(x, y) = {1, 1, 1, 1};
    return out;
}

TEST_F(ComposeOpacity, IsRefusedWhereThePlanThatIsOnItsWayCannotMix) {
    const Host host(black_beside_white());
    for (const std::uint32_t threads : {0U, 1U}) {
        SCOPED_TRACE(threads);
        Composer composer(host.device, {.max_threads = threads});
        const Handle blur = add(composer, "gaussian_blur", {{"radius", 6}}, {.opacity = 0.5f});
        const Handle negative = add(composer, "negative");
        test::must(composer.compile(host.compile_desc()));
        test::must(composer.set_opacity(blur, 1));
        test::must(composer.compile_later(host.compile_desc()));
        const auto set = composer.set_opacity(blur, 0.25f);
        EXPECT_FALSE(set) << "accepted";
        if (!set) {
            EXPECT_NE(set.error().text.find("passes of its own"), std::string::npos) << set.error().text;
        }
        EXPECT_EQ(composer.desc(blur)->opacity, 1);
        // What always can be mixed is not refused.
        test::must(composer.set_opacity(negative, 0.25f));
        test::must(composer.set_opacity(blur, 0));
        test::must(composer.set_opacity(blur, 1));
        test::must(composer.compile(host.compile_desc()));
        EXPECT_FALSE(composer.set_opacity(blur, 0.25f)) << "the new plan cannot mix either";
    }
}

}  // namespace
}  // namespace darkroom
