// SPDX-License-Identifier: MIT
#include "bench/chain/recipe.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <darkroom/look.hpp>
#include <filesystem>
#include <optional>

#include "develop/developer.hpp"
#include "render/renderer.hpp"
#include "scene/assets.hpp"
#include "scene/pose/snapshot.hpp"
#include "scene/scene.hpp"

namespace darkroom::bench {

namespace {

constexpr VkExtent2D scene_extent{1280, 720};

/// A scene that is ready to be drawn, at a moment.
struct Drawing {
    scene::Scene scene;
    scene::Assets assets;
    scene::Snapshot snapshot;
    std::optional<render::Renderer> renderer;
};

/// How the shadows of a row are drawn.
enum class Shadows : std::uint8_t { None, Plain, Soft };

Result<std::shared_ptr<Drawing>> draw(Bed& bed, scene::Scene scene, Shadows shadows = Shadows::Soft) {
    const auto out = std::make_shared<Drawing>();
    out->scene = std::move(scene);
    out->assets = scene::load_assets(out->scene);
    constexpr float aspect = static_cast<float>(scene_extent.width) / static_cast<float>(scene_extent.height);
    out->snapshot = scene::snapshot(out->scene, out->assets, {.aspect = aspect});
    const render::RenderDesc desc{
        .extent = scene_extent,
        .cascades = {.filter = shadows == Shadows::Plain ? render::ShadowFilter::Plain : render::ShadowFilter::Soft},
        .draw = {.has_shadows = shadows != Shadows::None, .has_grid = out->scene.has_grid}};
    DARKROOM_TRY_VALUE(auto renderer, render::Renderer::create(bed.device, out->scene, out->assets, desc));
    out->renderer.emplace(std::move(renderer));
    DARKROOM_TRY(out->renderer->prepare(out->snapshot));
    return out;
}

Row drawing_row(const std::string& name, const std::shared_ptr<Drawing>& drawing) {
    return {.name = name,
            .record = [drawing](VkCommandBuffer commands) { return drawing->renderer->record(commands); }};
}

std::filesystem::path path_of(std::string_view scene) {
    return fmt::format(DARKROOM_SOURCE_FOLDER "/scenes/{}.scene.toml", scene);
}

/// Nothing where the file is not on this machine.
Result<std::shared_ptr<Drawing>> draw_shipped(Bed& bed, const std::string& row, std::string_view name,
                                              Shadows shadows = Shadows::Soft) {
    std::error_code error;
    const std::filesystem::path path = path_of(name);
    if (!std::filesystem::exists(path, error)) {
        fmt::print(stderr, "{}: left out, {} is not there\n", row, path.string());
        return std::shared_ptr<Drawing>();
    }
    DARKROOM_TRY_VALUE(auto scene, scene::read_scene(path));
    return draw(bed, std::move(scene), shadows);
}

Recipe shipped_recipe(std::string_view row, std::string_view scene, Shadows shadows) {
    return {std::string(row), [=](Bed& bed, const std::string& name) -> Result<Row> {
                DARKROOM_TRY_VALUE(const auto drawing, draw_shipped(bed, name, scene, shadows));
                return drawing ? drawing_row(name, drawing) : Row{.name = name};
            }};
}

/// The look of the scene on the frame of the scene, which is drawn once.
struct Post {
    std::shared_ptr<Drawing> drawing;
    std::unique_ptr<Composer> composer;
    gpu::Image target;
    Frame frame;
};

Result<Row> dungeon_post_row(Bed& bed, const std::string& name) {
    DARKROOM_TRY_VALUE(const auto drawing, draw_shipped(bed, name, "dungeon"));
    if (!drawing) return Row{.name = name};
    DARKROOM_TRY_VALUE(auto look, read_look(path_of("dungeon"), {.is_scene = true}));
    const auto post = std::make_shared<Post>();
    post->drawing = drawing;
    post->composer = std::make_unique<Composer>(bed.device, ComposerDesc{.frames_in_flight = 1});
    DARKROOM_TRY(apply(look, *post->composer));
    post->frame = post->drawing->renderer->frame();
    for (ImageRef* const image : {&post->frame.color, &post->frame.depth, &post->frame.normals, &post->frame.velocity})
        image->final_layout = image->layout;
    const CompileDesc desc =
        compile_desc_for(bed.device,
                         DeviceFrame{.frame = post->frame,
                                     .color_usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT,
                                     .layer_usage = post->drawing->renderer->layer_usage()},
                         {});
    DARKROOM_TRY(post->composer->compile(desc));
    post->composer->wait_for_kernels();
    DARKROOM_TRY_VALUE(post->target,
                       gpu::Image::create(bed.context, {.name = "target",
                                                        .format = desc.target.format,
                                                        .extent = {scene_extent.width, scene_extent.height, 1},
                                                        .usage = desc.target.usage}));
    post->frame.target = {.image = post->target.handle,
                          .view = post->target.mip_views[0],
                          .format = desc.target.format,
                          .extent = scene_extent,
                          .last_access = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT};
    Result<> recorded{};
    const Result<> drawn = gpu::submit_and_wait(bed.context, "drawing the dungeon", [&](VkCommandBuffer commands) {
        recorded = post->drawing->renderer->record(commands);
    });
    if (!recorded || !drawn) return failure(recorded ? drawn.error() : recorded.error());
    return Row{.name = name,
               .record = [post](VkCommandBuffer commands) { return post->composer->record(commands, post->frame); }};
}

/// A field of boxes of many sizes and colours, all of them before the camera.
scene::Scene boxes() {
    constexpr std::uint32_t side = 100;
    scene::Scene out{.name = "10,000 boxes", .has_grid = false};
    out.camera.is_given = true;
    out.camera.position = {0, 30, 75};
    for (std::uint32_t i = 0; i < side * side; ++i) {
        const auto x = static_cast<float>(i % side) - side / 2.0F, z = static_cast<float>(i / side) - side / 2.0F;
        const float height = 0.3F + static_cast<float>(i * 7 % 13) / 6;
        scene::Entity box{.name = fmt::format("box {}", i)};
        box.bounds = scene::Box{.low = {x, 0, z}, .high = {x + 0.7F, height, z + 0.7F}};
        box.material =
            scene::Material{.color = scene::vec3(static_cast<float>(i % 5) / 5, static_cast<float>(i % 7) / 7, 0.5F),
                            .roughness = 0.2F + static_cast<float>(i % 3) / 4};
        out.entities.push_back(std::move(box));
    }
    return out;
}

Result<Row> boxes_row(Bed& bed, const std::string& name) {
    DARKROOM_TRY_VALUE(const auto drawing, draw(bed, boxes()));
    return drawing_row(name, drawing);
}

/// What a frame of them costs the CPU: the snapshot, culling, sorting, filling buffers.
Result<Row> boxes_host_row(Bed& bed, const std::string& name) {
    const auto drawing = draw(bed, boxes());
    if (!drawing) return failure(drawing.error());
    return Row{.name = name, .host = [drawing = *drawing] {
                   const float aspect =
                       static_cast<float>(scene_extent.width) / static_cast<float>(scene_extent.height);
                   drawing->snapshot = scene::snapshot(drawing->scene, drawing->assets, {.aspect = aspect});
                   // Succeeded before, with the same boxes.
                   static_cast<void>(drawing->renderer->prepare(drawing->snapshot));
               }};
}

}  // namespace

std::vector<Recipe> scene_recipes() {
    return {shipped_recipe(dungeon_scene_name, "dungeon", Shadows::Soft),
            shipped_recipe(dungeon_plain_name, "dungeon", Shadows::Plain),
            shipped_recipe(dungeon_unshadowed_name, "dungeon", Shadows::None),
            shipped_recipe(street_name, "street", Shadows::Soft),
            shipped_recipe(street_unshadowed_name, "street", Shadows::None),
            {std::string(dungeon_post_name), dungeon_post_row},
            {"scene: 10,000 boxes", boxes_row},
            {"scene: 10,000 boxes, snapshot and prepare", boxes_host_row}};
}

}  // namespace darkroom::bench
