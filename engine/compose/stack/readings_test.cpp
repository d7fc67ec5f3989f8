// SPDX-License-Identifier: MIT
// Many pictures that are read in place: a kernel never has more images than a device promises, on any driver.

#include "compose/test_stacks/host.hpp"

namespace darkroom {
namespace {

using test::add;
using test::Host;

class ComposeReadings : public test::StackTest {
  protected:
    void SetUp() override {
        StackTest::SetUp();
        for (const std::string_view name : {"ui_warp", "ui_composite"})
            if (find_effect(name) == nullptr) GTEST_SKIP() << "this build has no effect " << name;
    }
};

/// Each picture is moved by a map of its own and laid over what is there, in place.
void fill_layers(Composer& composer, std::uint32_t pictures) {
    std::vector<Handle> moved;
    for (std::uint32_t i = 0; i < pictures; ++i) {
        const ReferenceImage picture = test::random_display(20, 12, 30 + i);
        ResourceImage image{.width = 20, .height = 12, .rgba = test::pixels_of(picture).rgba};
        for (std::size_t p = 0; p < image.rgba.size(); p += 4) image.rgba[p + 3] = p % 5 == 0 ? 0.5f : 0.0f;
        const Resource resource = test::must(composer.define(std::move(image)));
        moved.push_back(add(composer, "ui_warp", {{"strength", 0.01}}, {.input = Composer::picture_of(resource)}));
    }
    add(composer, "exposure", {}, {.input = scene_color});
    for (const Handle layer : moved) add(composer, "ui_composite", {}, {.second = layer});
}

TEST_F(ComposeReadings, ALookOfManyPairsOfMapAndLayerIsDrawn) {
    const Host host(test::round_to_float(test::random_display(20, 12, 3)));
    const gpu::test::Picture ui =
        gpu::test::upload(host.device.context(), test::pixels_of(test::uniform(20, 12, {0, 0, 0, 0})),
                          VK_FORMAT_R8G8B8A8_UNORM, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    for (const std::uint32_t pictures : {7U, 20U}) {
        SCOPED_TRACE(pictures);
        ReferenceImage unfused;
        for (const bool is_fused : {false, true}) {
            for (const KernelStage stage : {KernelStage::Raster, KernelStage::Compute}) {
                Composer composer(host.device, {.max_threads = 0});
                fill_layers(composer, pictures);
                CompileDesc desc = host.compile_desc();
                desc.fuse = is_fused;
                desc.kernels = stage;
                desc.ui = {VK_FORMAT_R8G8B8A8_UNORM, ui.image.info.usage};
                const auto plan = composer.compile(desc);
                ASSERT_TRUE(plan) << plan.error().text;
                Frame frame = host.frame();
                frame.ui = test::image_ref(ui);
                test::must(host.record(composer, frame));
                const ReferenceImage out = host.read_target();
                if (unfused.pixels.empty()) unfused = out;
                EXPECT_LE(test::worst_difference(out, unfused), 1 / 255.0) << (is_fused ? "fused" : "unfused");
                // Maps and layers that are off are not read, and what is loaded beside them is.
                for (std::uint32_t i = 0; i < pictures; i += 2)
                    test::must(composer.set_enabled(composer.entry(i), false));
                test::must(host.record(composer, frame));
                EXPECT_TRUE(std::ranges::all_of(host.read_target().pixels,
                                                [](const Rgba& p) { return std::isfinite(p.r + p.g + p.b); }));
            }
        }
    }
}

}  // namespace
}  // namespace darkroom
