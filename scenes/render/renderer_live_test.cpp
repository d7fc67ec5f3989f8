// SPDX-License-Identifier: MIT
// What a viewer does to a renderer while it runs: other sizes, other options, a second renderer of the same scene.
#include <gtest/gtest.h>

#include <chrono>
#include <future>
#include <map>
#include <utility>

#include "render/renderer_test_support.hpp"

namespace darkroom::render {
namespace {

using namespace test;

constexpr VkExtent2D small{64, 48};

/// A sun that casts, a lamp, boxes that are opaque and that are glass, a room, particles, and a mask behind the camera.
scene::Scene hall() {
    return must(scene::parse_scene(R"(
[camera]
position = [4, 3, 6]
[entities.sun.light]
direction = [1, 0.6, 0.4]
intensity = 2
[entities.lamp]
transform = { position = [0, 2, 0] }
light = { type = "point", color = [1, 0.5, 0.2], intensity = 4 }
[entities.floor]
bounds = { min = [-5, -0.1, -5], max = [5, 0, 5] }
[entities.box]
bounds = { min = [-0.5, 0, -0.5], max = [0.5, 1.5, 0.5] }
material = { color = [0.8, 0.2, 0.1], roughness = 0.3 }
[entities.glass]
bounds = { min = [1, 0, 1], max = [2, 1, 2] }
material = { color = [0.2, 0.4, 0.8], opacity = 0.5 }
[entities.room]
archetype = "room"
bounds = { min = [-4, 0, -4], max = [4, 4, 4] }
[entities.behind]
bounds = { min = [7, 0, 14], max = [9, 4, 15] }
material = { blend_mode = "mask" }
[entities.sparks]
transform = { position = [-1, 0, 1] }
particle_emitter = { emission_rate = 30 }
)",
                                   "hall.scene.toml"));
}

scene::Snapshot seen(const scene::Scene& scene, const scene::Assets& assets, VkExtent2D extent) {
    const float aspect = static_cast<float>(extent.width) / static_cast<float>(extent.height);
    return scene::snapshot(scene, assets, {.time = 1, .previous_time = 0.9, .aspect = aspect});
}

class RenderGpuLive : public ::testing::Test {
  protected:
    [[nodiscard]] Renderer create(RenderDesc desc) const {
        desc.cascades.resolution = 256;
        return must(Renderer::create(gpu::test::device(), scene, assets, desc));
    }
    Shot shoot(Renderer& renderer) const { return test::shoot(renderer, seen(scene, assets, renderer.desc().extent)); }
    void expect_same(Renderer& actual, Renderer& expected, std::string_view what) const {
        const Shot a = shoot(actual), b = shoot(expected);
        EXPECT_EQ(a.color.rgba, b.color.rgba) << what;
        EXPECT_EQ(a.depth.rgba, b.depth.rgba) << what;
        EXPECT_EQ(a.normals.rgba, b.normals.rgba) << what;
        EXPECT_EQ(a.velocity.rgba, b.velocity.rgba) << what;
    }

    scene::Scene scene = hall();
    scene::Assets assets = scene::load_assets(scene);
};

/// Device memory in use, and copies to the device, of this test's context while it lives.
class Watch {
  public:
    Watch() {
        real = vk;
        vk.AllocateMemory = [](VkDevice device, const VkMemoryAllocateInfo* info, const VkAllocationCallbacks* with,
                               VkDeviceMemory* memory) {
            const VkResult result = real.AllocateMemory(device, info, with, memory);
            if (result == VK_SUCCESS) sizes[*memory] = info->allocationSize;
            return result;
        };
        vk.FreeMemory = [](VkDevice device, VkDeviceMemory memory, const VkAllocationCallbacks* with) {
            sizes.erase(memory);
            real.FreeMemory(device, memory, with);
        };
        vk.CmdCopyBuffer = [](VkCommandBuffer commands, VkBuffer from, VkBuffer to, std::uint32_t count,
                              const VkBufferCopy* regions) {
            ++uploads;
            real.CmdCopyBuffer(commands, from, to, count, regions);
        };
        vk.CmdCopyBufferToImage = [](VkCommandBuffer commands, VkBuffer from, VkImage to, VkImageLayout layout,
                                     std::uint32_t count, const VkBufferImageCopy* regions) {
            ++uploads;
            real.CmdCopyBufferToImage(commands, from, to, layout, count, regions);
        };
        sizes.clear();
        uploads = 0;
    }
    Watch(const Watch&) = delete;
    Watch& operator=(const Watch&) = delete;
    ~Watch() { vk = real; }
    /// Of what was made since.
    static VkDeviceSize bytes() {
        VkDeviceSize sum = 0;
        for (const auto& [memory, size] : sizes) sum += size;
        return sum;
    }
    static inline int uploads = 0;

  private:
    gpu::Dispatch& vk = gpu::test::context().vk;
    static inline gpu::Dispatch real;
    static inline std::map<VkDeviceMemory, VkDeviceSize> sizes;
};

/// From one pixel to large and odd ones, long and high, and back.
VkExtent2D size_of_step(std::uint32_t step) {
    if (step % 50 == 49) return {1023 + step, 517};
    return {1 + step * 37 % 211, 1 + step * step * 13 % 173};
}

TEST_F(RenderGpuLive, TwoHundredSizesTakeNoMemoryAndNoPipeline) {
    const Watch watch;
    Renderer renderer = create({.extent = small});
    const auto draw_all = [&] {
        for (std::uint32_t step = 0; step < 200; ++step) {
            const VkExtent2D extent = size_of_step(step);
            must(renderer.resize(extent));
            ASSERT_EQ(renderer.picture().extent.width, extent.width);
            ASSERT_EQ(renderer.picture().extent.height, extent.height);
            draw(renderer, seen(scene, assets, extent));
        }
        must(renderer.resize(small));
    };
    // Other shapes of the picture have other casters.
    draw_all();
    const VkDeviceSize before = Watch::bytes();
    const std::uint64_t pipelines = gpu::test::context().pipelines_created;
    const int uploads = Watch::uploads;
    EXPECT_GT(uploads, 0);
    draw_all();
    EXPECT_EQ(Watch::bytes(), before);
    EXPECT_EQ(gpu::test::context().pipelines_created, pipelines);
    EXPECT_EQ(Watch::uploads, uploads);
}

TEST_F(RenderGpuLive, AResizedPictureIsThatOfAFreshRenderer) {
    for (const RenderDesc& desc :
         {RenderDesc{.extent = small}, RenderDesc{.extent = small, .samples = 4},
          RenderDesc{.extent = small, .output = Output::Display},
          RenderDesc{.extent = small, .samples = 4, .output = Output::Display, .frames_in_flight = 2}}) {
        if ((gpu::test::context().traits.sample_counts & desc.samples) == 0) continue;
        Renderer renderer = create(desc);
        for (const VkExtent2D extent : {VkExtent2D{1, 1}, {641, 479}, {7, 333}, {31, 17}, small}) {
            must(renderer.resize(extent));
            RenderDesc same = desc;
            same.extent = extent;
            Renderer fresh = create(same);
            expect_same(renderer, fresh, std::to_string(extent.width));
        }
    }
}

TEST_F(RenderGpuLive, ARefusedSizeLeavesTheOldOne) {
    Renderer renderer = create({.extent = small});
    const Pixels before = shoot(renderer).color;
    EXPECT_FALSE(renderer.resize({0, 48}));
    EXPECT_FALSE(renderer.resize({64, 1U << 30U}));
    EXPECT_EQ(shoot(renderer).color.rgba, before.rgba);
}

/// One option other than the usual at a time.
std::vector<DrawOptions> options_of(Output output) {
    std::vector<DrawOptions> out{{}, {.has_shadows = false}, {.has_grid = false}, {.has_normal_arrows = true}};
    const bool has_edges = gpu::test::context().traits.has_wireframe;
    if (has_edges) out.push_back({.has_wireframe_overlay = true});
    if (output == Output::Hdr) return out;
    for (const DebugView view : {DebugView::Wireframe, DebugView::Normals, DebugView::Depth, DebugView::Uv,
                                 DebugView::Unlit, DebugView::MetalRough})
        if (view != DebugView::Wireframe || has_edges) out.push_back({.debug = view});
    return out;
}

TEST_F(RenderGpuLive, OptionsOfAFrameAreThoseOfARendererMadeWithThem) {
    for (const Output output : {Output::Hdr, Output::Display}) {
        Renderer renderer = create({.extent = small, .output = output});
        const std::vector<DrawOptions> all = options_of(output);
        std::vector<Pixels> pictures;
        for (const DrawOptions& options : all) {
            must(renderer.set(options));
            Renderer fresh = create({.extent = small, .output = output, .draw = options});
            expect_same(renderer, fresh, "option " + std::to_string(pictures.size()));
            pictures.push_back(shoot(renderer).color);
            for (std::size_t i = 0; i + 1 < pictures.size(); ++i)
                EXPECT_NE(pictures.back().rgba, pictures[i].rgba)
                    << "option " << pictures.size() - 1 << " shows as " << i;
        }
        // Once more, when all pipelines are made.
        const Watch watch;
        const std::uint64_t pipelines = gpu::test::context().pipelines_created;
        for (std::size_t i = 0; i < all.size(); ++i) {
            must(renderer.set(all[i]));
            EXPECT_EQ(shoot(renderer).color.rgba, pictures[i].rgba) << i;
        }
        EXPECT_EQ(gpu::test::context().pipelines_created, pipelines);
        EXPECT_EQ(Watch::uploads, 0);
    }
}

TEST_F(RenderGpuLive, ShadowsAndGridNeedNoPipeline) {
    Renderer renderer = create({.extent = small});
    shoot(renderer);
    const std::uint64_t pipelines = gpu::test::context().pipelines_created;
    for (const DrawOptions& options : {DrawOptions{.has_shadows = false}, {.has_grid = false}, {}}) {
        must(renderer.set(options));
        shoot(renderer);
        EXPECT_EQ(renderer.frame().lights[0].cascades.is_given(), options.has_shadows);
    }
    EXPECT_EQ(gpu::test::context().pipelines_created, pipelines);
}

TEST_F(RenderGpuLive, NoPipelineIsMadeAfterTheWarmUp) {
    const scene::OrbitOverride back{.distance = 0.0F, .yaw = 180.0F, .pitch = 0.0F, .target = scene.camera.position};
    for (const Output output : {Output::Hdr, Output::Display}) {
        Renderer renderer = create({.extent = small, .output = output});
        must(renderer.warm_up());
        const std::uint64_t pipelines = gpu::test::context().pipelines_created;
        for (const DrawOptions& options : options_of(output)) {
            must(renderer.set(options));
            shoot(renderer);
            draw(renderer, scene::snapshot(scene, assets, {.aspect = 4.0F / 3, .orbit = back}));
            EXPECT_GT(renderer.counters().draw_calls, 0U);
        }
        EXPECT_EQ(gpu::test::context().pipelines_created, pipelines);
    }
}

TEST_F(RenderGpuLive, OptionsThatCannotBeAreRefusedAndChangeNothing) {
    Renderer renderer = create({.extent = small});
    const Pixels before = shoot(renderer).color;
    const Result<> refused = renderer.set({.has_grid = false, .debug = DebugView::Depth});
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().text, "debug view: it is a picture of its own and needs the display output, not hdr");
    gpu::Context& context = gpu::test::context();
    const bool had_edges = std::exchange(context.traits.has_wireframe, false);
    const Result<> no_edges = renderer.set({.has_wireframe_overlay = true});
    const Result<Renderer> no_view =
        renderer.sharing({.extent = small, .output = Output::Display, .draw = {.debug = DebugView::Wireframe}});
    context.traits.has_wireframe = had_edges;
    ASSERT_FALSE(no_edges);
    EXPECT_EQ(no_edges.error().text, "wireframe overlay: " + context.info.name + " cannot draw the edges of triangles");
    ASSERT_FALSE(no_view);
    EXPECT_EQ(no_view.error().text,
              "debug view wireframe: " + context.info.name + " cannot draw the edges of triangles");
    EXPECT_EQ(shoot(renderer).color.rgba, before.rgba);
}

TEST_F(RenderGpuLive, RenderersOfOneSceneShareItsAssets) {
    assets.skybox.emplace(32, 16);
    std::ranges::fill(assets.skybox->pixels, 0.5F);
    auto hdr = std::make_unique<Renderer>(create({.extent = small}));
    const RenderDesc desc{.extent = small, .output = Output::Display, .cascades = {.resolution = 256}};
    Renderer alone = create(desc);
    const Watch watch;
    Renderer display = must(hdr->sharing(desc));
    EXPECT_EQ(Watch::uploads, 0);
    expect_same(display, alone, "display");
    Renderer again = create({.extent = small});
    expect_same(*hdr, again, "hdr");
    hdr.reset();
    expect_same(display, alone, "after the first is gone");
}

TEST_F(RenderGpuLive, ASceneIsReplacedWhileTheOldOneIsDrawn) {
    Renderer before = create({.extent = small});
    const Pixels expected = shoot(before).color;
    auto next = std::async(std::launch::async, [this] {
        scene::Scene brighter = scene;
        brighter.environment.ambient_intensity = 3;
        Renderer made = must(Renderer::create(gpu::test::device(), brighter, assets, {.extent = small}));
        must(made.warm_up());
        return made;
    });
    int frames = 0;
    do {
        EXPECT_EQ(shoot(before).color.rgba, expected.rgba);
        ++frames;
    } while (next.wait_for(std::chrono::seconds(0)) != std::future_status::ready && frames < 10'000);
    Renderer after = next.get();
    EXPECT_NE(shoot(after).color.rgba, expected.rgba);
}

TEST_F(RenderGpuLive, DebugViewsNeedNoShadowMaps) {
    Renderer hdr = create({.extent = small});
    const Watch watch;
    Renderer debug = must(hdr.sharing({.extent = small,
                                       .output = Output::Display,
                                       .cascades = {.resolution = 2048},
                                       .draw = {.debug = DebugView::Uv}}));
    shoot(debug);
    EXPECT_LT(Watch::bytes(), VkDeviceSize{1} << 20U);
    must(debug.set({}));
    shoot(debug);
    EXPECT_GT(Watch::bytes(), VkDeviceSize{1} << 24U);
}

}  // namespace
}  // namespace darkroom::render
