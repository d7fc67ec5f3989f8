// SPDX-License-Identifier: MIT
// Every image and every entry of every look that ships can be watched, at sizes that leave little of a pyramid.

#include <darkroom/look.hpp>
#include <deque>
#include <filesystem>

#include "compose/test_stacks/host.hpp"
#include "compose/test_stacks/shadow_map.hpp"
#include "tests/places.hpp"

namespace darkroom {
namespace {

constexpr VkFormat float_format = VK_FORMAT_R32G32B32A32_SFLOAT;

/// Frames with all that looks read.
struct FullHost : test::Host {
    FullHost(std::uint32_t width, std::uint32_t height)
        : Host(test::round_to_float(test::random_display(width, height, 4))) {
        gpu::Context& context = device.context();
        const auto upload = [&](const Rgba& value, VkFormat format) {
            return gpu::test::upload(context, test::pixels_of(test::uniform(width, height, value)), format,
                                     VK_IMAGE_LAYOUT_GENERAL);
        };
        depth = upload({5, 0, 0, 1}, VK_FORMAT_R32_SFLOAT);
        normals = upload({0, 0, 1, 1}, float_format);
        velocity = upload({1, 2, 0, 0}, float_format);
        ui = upload({0.25, 0.25, 0.25, 0.5}, VK_FORMAT_R8G8B8A8_UNORM);
        ReferenceLight light{.light = {.direction = {0, 0, -1}, .volumetric_intensity = 1}, .resolution = 4};
        light.cascades.emplace_back(16, 1.0F);
        shadows = test::upload_shadow_map(context, light);
        lights = {light.light};
        lights[0].cascades = test::shadow_map_ref(shadows);
        lights[0].cascade_count = 1;
    }
    [[nodiscard]] CompileDesc full_desc() const {
        CompileDesc out = compile_desc();
        out.depth = {VK_FORMAT_R32_SFLOAT};
        out.is_depth_planar = true;
        out.normals = out.velocity = {float_format};
        out.is_velocity_plain = true;
        out.ui = {VK_FORMAT_R8G8B8A8_UNORM};
        out.has_shadows = true;
        return out;
    }
    [[nodiscard]] Frame full_frame() const {
        Frame out = frame();
        out.depth = test::image_ref(depth);
        out.normals = test::image_ref(normals);
        out.velocity = test::image_ref(velocity);
        out.ui = test::image_ref(ui);
        out.camera.depth = DepthKind::Planar;
        out.lights = lights;
        return out;
    }
    gpu::test::Picture depth, normals, velocity, ui;
    gpu::Image shadows;
    std::vector<Light> lights;
};

class ChainWatch : public test::StackTest {
  protected:
    /// Watches all that the plan names. Gives how many are shown.
    std::size_t watch_all(Composer& composer, const FullHost& host) {
        CompileDesc desc = host.full_desc();
        const Plan plan = test::must(composer.plan(desc));
        const ImageUse use{float_format, gpu::test::all_usage(host.device.context(), float_format)};
        const auto add = [&](Watch watch) {
            watch.id = static_cast<std::uint32_t>(desc.watches.size());
            watch.target = use;
            desc.watches.push_back(watch);
        };
        for (const PlanImage& image : plan.images)
            for (std::uint32_t level = 0; level < image.mip_levels; ++level)
                add({.image = image.name, .mip_level = level});
        for (std::size_t i = 0; i < composer.size(); ++i) add({.entry = composer.entry(i)});
        test::must(composer.compile(desc));
        while (targets.size() < desc.watches.size())
            targets.push_back(gpu::test::blank(host.device.context(), {3, 2}, float_format));
        std::vector<Watched> watched;
        for (const Watch& watch : desc.watches)
            watched.push_back({.id = watch.id, .target = test::image_ref(targets[watch.id])});
        std::size_t shown = 0;
        for (int frames = 0; frames < 2; ++frames) {
            Frame frame = host.full_frame();
            frame.watched = watched;
            test::must(host.record(composer, frame));
        }
        for (const Watch& watch : desc.watches) {
            const WatchState state = composer.watch_state(watch.id);
            shown += state == WatchState::Shown ? 1 : 0;
            const bool is_array = watch.image.starts_with("shadow ");
            EXPECT_EQ(state == WatchState::NotInPlan, is_array) << watch.image << " level " << watch.mip_level;
        }
        return shown;
    }
    std::deque<gpu::test::Picture> targets;
};

TEST_F(ChainWatch, EveryImageOfEveryShippedLookIsSeen) {
    const std::uint64_t messages = gpu::test::device().validation_messages();
    for (const auto& [width, height] : {std::pair{1u, 1u}, {7u, 5u}, {65u, 37u}}) {
        const FullHost host(width, height);
        for (const auto& file :
             std::filesystem::directory_iterator(std::filesystem::path(test::source_folder) / "looks")) {
            if (file.path().extension() != ".toml") continue;
            SCOPED_TRACE(file.path().filename());
            const auto look = read_look(file.path(), {});
            ASSERT_TRUE(look) << look.error().text;
            Composer composer(host.device);
            test::must(apply(*look, composer));
            EXPECT_GE(watch_all(composer, host), 3u) << width << "x" << height;
        }
        // All effects of the table, with what is off.
        const auto look = parse_look("[post_process]\n", "a.toml", {});
        ASSERT_TRUE(look) << look.error().text;
        Composer composer(host.device);
        test::must(apply(*look, composer, {.keeps_what_is_off = true}));
        EXPECT_GE(watch_all(composer, host), 3u);
    }
    EXPECT_EQ(gpu::test::device().validation_messages(), messages);
}

}  // namespace
}  // namespace darkroom
