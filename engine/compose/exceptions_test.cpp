// SPDX-License-Identifier: MIT
// No exception leaves a public function, and none ends a thread of the library's: it becomes an error, and the Composer
// goes on with what it had.

#include <darkroom/custom_effect.hpp>
#include <darkroom/describe.hpp>
#include <new>
#include <stdexcept>

#include "compose/test_stacks/host.hpp"
#include "core/test_support_failing.hpp"

namespace darkroom {
namespace {

using test::add;
using test::Host;
using test::with_each_allocation_failing;

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

// The effect's own function runs before there is any command, so the host may submit what it has.
TEST_F(ComposeExceptions, OneWhileRecordingRecordsNothing) {
    static bool throws;
    static constexpr auto constants = [](const void*, const PassContext&, std::span<PassVector>) {
        if (throws) throw std::runtime_error("the effect's own words");
    };
    EffectInfo info = thrower;
    info.build = [](PassBuilder& builder) { builder.end_constants(1, constants); };
    const Host host(test::random_display(8, 8, 3));
    Composer composer(host.device, {.frames_in_flight = 1});
    add(composer, "recursive_blend", {{"weight", 0.5}});
    composer.add(info, nullptr);
    test::must(composer.compile(host.compile_desc()));
    throws = false;
    const ReferenceImage expected = host.run(composer);
    static std::size_t barriers;
    gpu::Dispatch& vk = host.device.context().vk;
    const auto put_barriers = vk.CmdPipelineBarrier2;
    for (const bool is_first : {true, false}) {
        if (is_first) test::must(composer.compile(host.compile_desc()));
        throws = true;
        barriers = 0;
        vk.CmdPipelineBarrier2 = [](VkCommandBuffer, const VkDependencyInfo*) { ++barriers; };
        test::must(gpu::submit_and_wait(host.device.context(), "half a recording", [&](VkCommandBuffer buffer) {
            const auto recorded = composer.record(buffer, host.frame());
            ASSERT_FALSE(recorded);
            EXPECT_NE(recorded.error().text.find("the effect's own words"), std::string::npos);
        }));
        vk.CmdPipelineBarrier2 = put_barriers;
        EXPECT_EQ(barriers, 0u);
        EXPECT_FALSE(composer.abandon());
        throws = false;
        EXPECT_EQ(test::worst_difference(host.run(composer), expected), 0);
    }
}

// On a device that only plans, so that no driver and no compiler of others is in the way.
TEST_F(ComposeExceptions, EveryAllocationOfEveryFunctionMayFail) {
    if (!test::counts_allocations()) GTEST_SKIP() << "this build has its own operator new";
    const Device device = Device::assumed();
    const CompileDesc desc{.max_extent = {64, 48}, .depth = {VK_FORMAT_D32_SFLOAT}};
    const std::string long_name(100, 'n');
    Composer composer(device);
    add(composer, "exposure");
    add(composer, "bloom");
    const Handle first = composer.entry(0);
    const std::string expected = test::must(composer.plan(desc)).text();
    const EffectInfo& negative = *find_effect("negative");
    // Arguments are the caller's own matter.
    const EntryDesc named{.name = long_name}, rewired{.name = "exposure", .output = long_name};
    const std::uint32_t word = std::bit_cast<std::uint32_t>(1.5f);
    const LayerDesc layer{.name = long_name, .values = {{.entry = first, .parameter = "exposure", .words = {word}}}};
    const PulseDesc pulse{.event = long_name, .entry = first, .parameter = "exposure"};

    with_each_allocation_failing("plan", [&] { return !composer.plan(desc); });
    EXPECT_EQ(test::must(composer.plan(desc)).text(), expected);
    with_each_allocation_failing("compile", [&] { return !composer.compile(desc); });
    with_each_allocation_failing("compile_later", [&] { return !composer.compile_later(desc); });
    with_each_allocation_failing("statistics", [&] { return !composer.statistics(desc); });
    with_each_allocation_failing("record", [&] { return !composer.record(VK_NULL_HANDLE, {}); });
    with_each_allocation_failing("abandon", [&] { return !composer.abandon(); });
    with_each_allocation_failing("rebind", [&] { return !composer.rebind(device); });
    const auto count = composer.size();
    with_each_allocation_failing("add and remove", [&] {
        const Handle added = composer.add(negative, nullptr, named);
        return !added.is_given() || !composer.remove(added);
    });
    const auto drop_others = [&] {
        while (composer.size() > count) test::must(composer.remove(composer.entry(composer.size() - 1)));
    };
    drop_others();
    with_each_allocation_failing("insert", [&] {
        const auto inserted = composer.insert(first, negative, nullptr, named);
        if (inserted) static_cast<void>(composer.remove(*inserted));
        return !inserted;
    });
    for (std::size_t i = composer.size(); i-- > 0;)
        if (composer.info(composer.entry(i)) == &negative) test::must(composer.remove(composer.entry(i)));
    with_each_allocation_failing("rewire", [&] { return !composer.rewire(first, rewired); });
    with_each_allocation_failing("replace", [&] { return !composer.replace(first, *composer.info(first), nullptr); });
    with_each_allocation_failing("set_override", [&] {
        const auto set = composer.set_override(first, "exposure", long_name, {&word, 1});
        composer.drop_overrides(long_name);
        return !set;
    });
    with_each_allocation_failing("set, refused", [&] { return !composer.set(first, "exposuer", 1.0); });
    with_each_allocation_failing("check", [&] { return !composer.check({}); });
    with_each_allocation_failing("add_layer", [&] {
        const auto set = composer.add_layer(layer);
        static_cast<void>(composer.layer_names());
        composer.remove_layer(long_name);
        return !set;
    });
    with_each_allocation_failing("add_pulse", [&] {
        const auto set = composer.add_pulse(pulse);
        composer.remove_pulses();
        return !set;
    });
    with_each_allocation_failing("values", [&] {
        static_cast<void>(composer.values_at(first, 0, {}));
        return composer.current(first).empty() || composer.pre_roll() > 1000;
    });
    with_each_allocation_failing("CustomEffect::parse", [&] {
        return !CustomEffect::parse(
            "// @effect mine: Mine.\n// @param float a = 1 in [0, 1]: One.\n"
            "vec4 mine(vec4 color, Pixel pixel, Mine parameters) { return color; }\n",
            "mine.glsl");
    });
    const std::string nowhere = "/nowhere/at/all.glsl";
    with_each_allocation_failing("CustomEffect::load", [&] { return !CustomEffect::load(nowhere); });
    with_each_allocation_failing("Device::adopt", [&] { return !Device::adopt({}); });
    drop_others();
    EXPECT_EQ(test::must(composer.plan(desc)).text(), expected) << "a call that failed left something behind";
}

}  // namespace
}  // namespace darkroom
