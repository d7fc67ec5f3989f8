// SPDX-License-Identifier: MIT
// Every Vulkan call of a stack's life fails once: adopted, compiled, recorded, edited, resized, compiled beside the
// frames, bound to another device.

#include "compose/test_stacks/host.hpp"
#include "gpu/device/loader.hpp"
#include "gpu/test_failing/attempts.hpp"

namespace darkroom {
namespace {

using gpu::test::Attempt;
using test::add;
using test::Host;

void append(std::vector<std::byte>& out, const ReferenceImage& picture) {
    const auto bytes = std::as_bytes(std::span(picture.pixels));
    out.insert(out.end(), bytes.begin(), bytes.end());
}

/// A table and one kernel.
void fill_small(Composer& composer) {
    add(composer, "exposure");
    add(composer, "encode");
    add(composer, "dither");
}

/// Pyramids, tables, a picture of the host's, and a history.
void fill(Composer& composer, bool has_history) {
    ResourceImage image{.width = 8, .height = 8, .rgba = std::vector<float>(std::size_t{4} * 8 * 8, 0.25f)};
    const Resource picture = test::must(composer.define(std::move(image)));
    add(composer, "bloom");
    const Handle blur = add(composer, "gaussian_blur");
    if (has_history) add(composer, "blend", {}, {.second = blur.previous(), .opacity = 0.5f});
    add(composer, "blend", {}, {.second = Composer::picture_of(picture), .opacity = 0.5f});
    add(composer, "encode");
    add(composer, "dither");
}

class VulkanStack : public test::StackTest {
  protected:
    const ReferenceImage picture = test::round_to_float(test::random_display(40, 24, 7));
    const ReferenceImage larger = test::round_to_float(test::random_display(61, 33, 8));
    const Host host{picture}, large_host{larger};

    /// Edits, another size, another device.
    std::vector<std::byte> life(Attempt& attempt) const {
        std::vector<std::byte> out;
        auto device = attempt("adopting", [&] { return attempt.adopted(host.device); });
        if (!device) return out;
        Composer composer(*device, {.has_timers = true, .max_threads = 0});
        fill(composer, true);
        const auto compile = [&](const Host& on) {
            return attempt("compiling", [&] { return composer.compile(on.compile_desc()); }).has_value();
        };
        const auto shoot = [&](const Host& on) {
            append(out, on.run(composer));
            static_cast<void>(composer.times());
        };
        if (!compile(host)) return out;
        shoot(host);
        composer.wait_for_kernels();
        shoot(host);
        add(composer, "vignette");
        if (!compile(host)) return out;
        shoot(host);
        if (!compile(large_host)) return out;
        shoot(large_host);
        auto other = attempt("adopting another", [&] { return attempt.adopted(host.device); });
        if (!other) return out;
        if (!attempt("binding", [&] { return composer.rebind(*other); })) return out;
        shoot(large_host);
        return out;
    }

    std::vector<std::byte> short_life(Attempt& attempt) const {
        std::vector<std::byte> out;
        auto device = attempt("adopting", [&] { return attempt.adopted(host.device); });
        if (!device) return out;
        Composer composer(*device, {.max_threads = 0});
        fill_small(composer);
        for (const Host* const on : {&host, &large_host}) {
            if (!attempt("compiling", [&] { return composer.compile(on->compile_desc()); })) return out;
            append(out, on->run(composer));
        }
        return out;
    }

    /// The Composer's thread compiles, and builds lean kernels.
    std::vector<std::byte> beside(Attempt& attempt) const {
        std::vector<std::byte> out;
        auto device = attempt("adopting", [&] { return attempt.adopted(host.device); });
        if (!device) return out;
        Composer composer(*device, {.max_threads = 2});
        fill(composer, false);
        const auto compile_later = [&]() -> Result<> {
            DARKROOM_TRY(composer.compile_later(host.compile_desc()));
            for (PendingCompile pending = composer.pending();; pending = composer.pending()) {
                if (pending.error) return failure(*pending.error);
                if (!pending.is_pending) return {};
                // Before the first plan there is nothing to record.
                if (const auto recorded = host.record(composer, host.frame()); !recorded) std::this_thread::yield();
            }
        };
        if (!attempt("compiling beside", compile_later)) return out;
        append(out, host.run(composer));
        add(composer, "vignette");
        if (!attempt("compiling beside, edited", compile_later)) return out;
        append(out, host.run(composer));
        return out;
    }
};

/// A device of the library's own, with the layer.
std::vector<std::byte> creation(Attempt& attempt) {
    const PFN_vkGetInstanceProcAddr loader =
        gpu::test::failing::vulkan_over(gpu::test::must(gpu::open_vulkan_loader()));
    const DeviceDesc desc{.validate = true,
                          .log = [&](Severity, std::string_view text) { attempt.log(text); },
                          .cache_folder = gpu::test::context().cache_folder.string()};
    const auto context = attempt("creating a device", [&] { return gpu::create_context(loader, desc); });
    if (!context) return {};
    EXPECT_EQ((*context)->validation_messages, 0U);
    const std::string name = (*context)->info.name;
    const auto bytes = std::as_bytes(std::span(name));
    return {bytes.begin(), bytes.end()};
}

class GpuFailedCalls : public VulkanStack {};
class SoakFailedCalls : public VulkanStack {};

void report(std::string_view what, const gpu::test::Points& points) {
    fmt::print("{}: {} calls that may fail, {} points tried\n", what, points.calls, points.tried);
}

TEST_F(GpuFailedCalls, OfOneKernel) {
    report("one kernel", gpu::test::try_each_call([&](Attempt& attempt) { return short_life(attempt); }));
}
TEST_F(GpuFailedCalls, OfAStackBySeed) {
    report("a stack", gpu::test::try_each_call([&](Attempt& attempt) { return life(attempt); }, 4));
}
TEST_F(GpuFailedCalls, BesideTheFramesBySeed) {
    report("beside the frames", gpu::test::try_each_call([&](Attempt& attempt) { return beside(attempt); }, 4));
}
TEST_F(GpuFailedCalls, OfADevice) { report("a device", gpu::test::try_each_call(creation)); }
TEST_F(SoakFailedCalls, OfAStack) {
    report("a stack", gpu::test::try_each_call([&](Attempt& attempt) { return life(attempt); }));
}
TEST_F(SoakFailedCalls, BesideTheFrames) {
    report("beside the frames", gpu::test::try_each_call([&](Attempt& attempt) { return beside(attempt); }));
}

}  // namespace
}  // namespace darkroom
