// SPDX-License-Identifier: MIT
// No exception leaves a public function, and none ends a thread of the library's: it becomes an error, and the Composer
// goes on with what it had.

#include <darkroom/describe.hpp>
#include <new>
#include <stdexcept>

#include "compose/test_stacks/host.hpp"

namespace darkroom {
namespace {

using test::add;
using test::Host;

class ComposeExceptions : public test::StackTest {};

struct Thrower {
    float amount = 1;
};
enum class Throw { Nothing, Runtime, Memory, Other };
Throw what_build_throws = Throw::Nothing;

void build_thrower(PassBuilder&) {
    if (what_build_throws == Throw::Runtime) throw std::runtime_error("the builder's own words");
    if (what_build_throws == Throw::Memory) throw std::bad_alloc();
    if (what_build_throws == Throw::Other) throw 7;  // NOLINT(hicpp-exception-baseclass)
}
constexpr auto thrower_rows = describe(field<&Thrower::amount>("Of the picture.", {0, 2}));
constexpr EffectFile thrower_files[] = {
    {"thrower.glsl",
     "vec4 thrower(vec4 color, Pixel pixel, Thrower parameters) { return color * parameters.amount; }\n"}};
const EffectInfo thrower{.name = "thrower",
                         .doc = "Throws where its passes are built.",
                         .parameters = thrower_rows.table(),
                         .files = thrower_files,
                         .build = build_thrower};

TEST_F(ComposeExceptions, OneOfAnEffectIsAnErrorOfCompileAndThePlanGoesOn) {
    const Host host(test::random_display(8, 8, 3));
    Composer composer(host.device);
    what_build_throws = Throw::Nothing;
    composer.add(thrower, nullptr);
    test::must(composer.compile(host.compile_desc()));
    const ReferenceImage expected = host.run(composer);
    add(composer, "negative");
    for (const auto& [thrown, part] : {std::pair{Throw::Runtime, "the builder's own words"},
                                       {Throw::Memory, "out of memory"},
                                       {Throw::Other, "unknown exception"}}) {
        what_build_throws = thrown;
        const auto compiled = composer.compile(host.compile_desc());
        ASSERT_FALSE(compiled);
        EXPECT_EQ(compiled.error().fault, Fault::Machine);
        EXPECT_NE(compiled.error().text.find(part), std::string::npos) << compiled.error().text;
        EXPECT_FALSE(composer.plan(host.compile_desc()));
        EXPECT_EQ(test::worst_difference(host.run(composer), expected), 0);
    }
    what_build_throws = Throw::Nothing;
    test::must(composer.compile(host.compile_desc()));
    EXPECT_GT(test::worst_difference(host.run(composer), expected), 0.01);
}

TEST_F(ComposeExceptions, OneOnTheWorkerIsAnErrorOfPendingAndThePlanGoesOn) {
    const Host host(test::random_display(8, 8, 3));
    for (const std::uint32_t threads : {0U, 1U, 2U}) {
        SCOPED_TRACE(threads);
        Composer composer(host.device, {.max_threads = threads});
        what_build_throws = Throw::Nothing;
        composer.add(thrower, nullptr);
        test::must(composer.compile(host.compile_desc()));
        const ReferenceImage expected = host.run(composer);
        add(composer, "negative");
        what_build_throws = Throw::Runtime;
        test::must(composer.compile_later(host.compile_desc()));
        PendingCompile pending = composer.pending();
        while (pending.is_pending) {
            EXPECT_EQ(test::worst_difference(host.run(composer), expected), 0);
            pending = composer.pending();
        }
        ASSERT_TRUE(pending.error);
        EXPECT_NE(pending.error->text.find("the builder's own words"), std::string::npos) << pending.error->text;
        EXPECT_EQ(test::worst_difference(host.run(composer), expected), 0);
        // The thread lives.
        what_build_throws = Throw::Nothing;
        test::must(composer.compile_later(host.compile_desc()));
        while (composer.pending().is_pending) static_cast<void>(host.run(composer));
        EXPECT_FALSE(composer.pending().error);
        EXPECT_GT(test::worst_difference(host.run(composer), expected), 0.01);
    }
}

}  // namespace
}  // namespace darkroom
