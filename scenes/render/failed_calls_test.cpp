// SPDX-License-Identifier: MIT
// Every Vulkan call of a renderer's life fails once: scene uploaded, drawn, resized, shared, drawn with other options.
#include <fmt/format.h>

#include "gpu/test_failing/attempts.hpp"
#include "render/renderer_test_support.hpp"

namespace darkroom::render {
namespace {

using namespace test;
using gpu::test::Attempt;

constexpr VkExtent2D first_extent{24, 16}, later_extent{31, 17};

/// Whatever has a pass of its own.
scene::Scene small_hall() {
    return must(scene::parse_scene(R"(
[camera]
position = [4, 3, 6]
[entities.sun.light]
direction = [1, 0.6, 0.4]
intensity = 2
[entities.lamp]
transform = { position = [0, 2, 0] }
light = { type = "point", color = [1, 0.5, 0.2], intensity = 4 }
[entities.box]
bounds = { min = [-0.5, 0, -0.5], max = [0.5, 1.5, 0.5] }
[entities.glass]
bounds = { min = [1, 0, 1], max = [2, 1, 2] }
material = { color = [0.2, 0.4, 0.8], opacity = 0.5 }
[entities.sparks]
transform = { position = [-1, 0, 1] }
particle_emitter = { emission_rate = 30 }
)",
                                   "hall.scene.toml"));
}

class RendererCalls : public ::testing::Test {
  protected:
    /// A short life draws one picture.
    std::vector<std::byte> life(Attempt& attempt, bool is_short = false) const {
        std::vector<std::byte> out;
        auto device = attempt("adopting", [&] { return attempt.adopted(gpu::test::device()); });
        if (!device) return out;
        RenderDesc desc{.extent = first_extent};
        desc.cascades.resolution = 64;
        auto made = attempt("making a renderer", [&] { return Renderer::create(*device, scene_, assets_, desc); });
        if (!made) return out;
        Renderer renderer = std::move(*made);
        if (!shoot_into(out, attempt, renderer) || is_short) return out;
        if (!attempt("resizing", [&] { return renderer.resize(later_extent); })) return out;
        if (!shoot_into(out, attempt, renderer)) return out;
        desc.output = Output::Display;
        auto shown = attempt("sharing", [&] { return renderer.sharing(desc); });
        if (!shown) return out;
        DrawOptions options;
        options.debug = DebugView::Normals;
        if (!attempt("setting", [&] { return shown->set(options); })) return out;
        if (!attempt("warming up", [&] { return shown->warm_up(); })) return out;
        shoot_into(out, attempt, *shown);
        return out;
    }

  private:
    bool shoot_into(std::vector<std::byte>& out, Attempt& attempt, Renderer& renderer) const {
        const VkExtent2D extent = renderer.desc().extent;
        const float aspect = static_cast<float>(extent.width) / static_cast<float>(extent.height);
        const scene::Snapshot seen =
            scene::snapshot(scene_, assets_, {.time = 1, .previous_time = 0.9, .aspect = aspect});
        if (!attempt("preparing", [&] { return renderer.prepare(seen); })) return false;
        const auto record = [&] {
            Result<> recorded;
            must(gpu::submit_and_wait(gpu::test::context(), "rendering a test scene",
                                      [&](VkCommandBuffer commands) { recorded = renderer.record(commands); }));
            return recorded;
        };
        if (!attempt("recording", record)) return false;
        const Pixels pixels = download(renderer.picture());
        const auto bytes = std::as_bytes(std::span(pixels.rgba));
        out.insert(out.end(), bytes.begin(), bytes.end());
        return true;
    }

    scene::Scene scene_ = small_hall();
    scene::Assets assets_ = scene::load_assets(scene_);
};

class RenderGpuFailedCalls : public RendererCalls {};
class SoakRenderFailedCalls : public RendererCalls {};

TEST_F(RenderGpuFailedCalls, BySeed) {
    const gpu::test::Points points = gpu::test::try_each_call([&](Attempt& attempt) { return life(attempt, true); }, 4);
    fmt::print("a renderer: {} calls that may fail, {} points tried\n", points.calls, points.tried);
}
TEST_F(SoakRenderFailedCalls, All) {
    const gpu::test::Points points = gpu::test::try_each_call([&](Attempt& attempt) { return life(attempt); });
    fmt::print("a renderer: {} calls that may fail, {} points tried\n", points.calls, points.tried);
}

}  // namespace
}  // namespace darkroom::render
