// SPDX-License-Identifier: MIT
#include "scene_source.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/text/param_text.hpp"
#include "develop/developer.hpp"
#include "programs/darkroom/run/frames.hpp"

namespace app {

namespace render = darkroom::render;
namespace scene = darkroom::scene;
using darkroom::Result;

darkroom::Frame as_reusable(darkroom::Frame frame) {
    for (darkroom::ImageRef* const image : {&frame.color, &frame.depth, &frame.normals, &frame.velocity, &frame.ui})
        image->final_layout = image->layout;
    return frame;
}

bool is_same_place(const scene::OrbitOverride& a, const scene::OrbitOverride& b) {
    return a.distance == b.distance && a.yaw == b.yaw && a.pitch == b.pitch && a.target == b.target &&
           a.field_of_view == b.field_of_view && a.ortho_height == b.ortho_height &&
           a.least_far_distance == b.least_far_distance;
}

namespace {

/// The exposure is the display's alone.
bool is_equal(const render::DrawOptions& a, const render::DrawOptions& b, bool is_display) {
    return a.has_shadows == b.has_shadows && a.has_grid == b.has_grid && a.debug == b.debug &&
           (!is_display || a.exposure == b.exposure);
}

/// Does nothing move from one to the other, and has nothing moved before?
bool is_equal(const LiveMoment& a, const LiveMoment& b, bool is_moved) {
    const auto has_same_way = [](const LiveMoment& one, const LiveMoment& other) {
        if (!one.previous_orbit || !other.previous_orbit) return !one.previous_orbit && !other.previous_orbit;
        return is_same_place(*one.previous_orbit, *other.previous_orbit);
    };
    const bool is_display = a.is_post_off || a.draw.debug != render::DebugView::None;
    const bool is_same_time = a.time == b.time && a.previous_time == b.previous_time;
    return (is_same_time || !is_moved) && a.is_post_off == b.is_post_off && is_same_place(a.orbit, b.orbit) &&
           has_same_way(a, b) && is_equal(a.draw, b.draw, is_display);
}

/// Can its frames differ by their times alone?
bool is_moved_by_time(const scene::Scene& of, const scene::Assets& assets) {
    return std::ranges::any_of(of.entities,
                               [](const auto& entity) { return !entity.path.empty() || entity.emitter; }) ||
           std::ranges::any_of(assets.models, [](const auto& model) { return !model.animations.empty(); });
}

}  // namespace

SceneSource::SceneSource(darkroom::Device& device, std::filesystem::path file, const Desc& desc)
    : device_(device), file_(std::move(file)), desc_(desc) {}

Result<std::unique_ptr<SceneSource>> SceneSource::create(darkroom::Device& device, const std::filesystem::path& file,
                                                         const Desc& desc) {
    std::unique_ptr<SceneSource> out(new SceneSource(device, file, desc));
    DARKROOM_TRY(out->read());
    return out;
}

Result<> SceneSource::read() {
    DARKROOM_TRY_VALUE(
        scene_, scene::read_scene(
                    file_, {.is_strict = desc_.is_strict, .warnings = &warnings_, .named_files = desc_.named_files}));
    assets_ = scene::load_assets(scene_);
    if (scene::is_model_path(file_) && !assets_.model_errors.empty()) return failure(assets_.model_errors.front());
    DARKROOM_TRY(scene::check_snapshot(scene_, assets_));
    std::ranges::copy(assets_.warnings, std::back_inserter(warnings_));
    is_moved_ = is_moved_by_time(scene_, assets_);
    render::RenderDesc desc = desc_.render;
    desc.output = render::Output::Hdr;
    desc.draw = {};  // switches come with every frame
    DARKROOM_TRY_VALUE(render::Renderer made, render::Renderer::create(device_, scene_, assets_, desc));
    linear_.emplace(std::move(made));
    return linear_->warm_up();
}

bool SceneSource::must_wait(const LiveMoment& moment, VkExtent2D extent) const {
    const bool is_display = moment.is_post_off || moment.draw.debug != render::DebugView::None;
    const std::optional<render::Renderer>& used = is_display ? display_ : linear_;
    return used && (used->desc().extent.width != extent.width || used->desc().extent.height != extent.height);
}

bool SceneSource::is_another(const LiveMoment& moment) const {
    return !drawn_ || !is_equal(drawn_->first, moment, is_moved_);
}

Result<> SceneSource::prepare(const LiveMoment& moment, VkExtent2D extent) {
    const auto is_there = [&](const LiveMoment& before, VkExtent2D drawn) {
        return drawn.width == extent.width && drawn.height == extent.height && before.jitter.now == moment.jitter.now &&
               before.jitter.before == moment.jitter.before;
    };
    is_kept_ = !is_another(moment) && is_there(drawn_->first, drawn_->second);
    if (is_kept_) return {};
    drawn_.reset();
    is_display_ = moment.is_post_off || moment.draw.debug != render::DebugView::None;
    snapshot_ = scene::snapshot(scene_, assets_,
                                {.time = moment.time,
                                 .previous_time = moment.previous_time,
                                 .aspect = moment.aspect,
                                 .seed = desc_.seed,
                                 .orbit = moment.orbit,
                                 .previous_orbit = moment.previous_orbit});
    if (!is_prepared_) std::ranges::copy(snapshot_.warnings, std::back_inserter(warnings_));
    // compile_desc() asks the linear one, even before it is shown.
    if (!std::exchange(is_prepared_, true) && is_display_)
        DARKROOM_TRY(use(false, {.draw = {.has_shadows = moment.draw.has_shadows}}, extent));
    DARKROOM_TRY(use(is_display_, moment, extent));
    drawn_.emplace(moment, extent);
    return {};
}

Result<> SceneSource::use(bool is_display, const LiveMoment& moment, VkExtent2D extent) {
    if (is_display && !display_) {
        render::RenderDesc desc = desc_.render;
        desc.output = render::Output::Display;
        desc.draw = {};
        desc.extent = extent;
        DARKROOM_TRY_VALUE(render::Renderer made, linear_->sharing(desc));
        display_.emplace(std::move(made));
        DARKROOM_TRY(display_->warm_up());
    }
    render::Renderer& used = is_display ? *display_ : *linear_;
    const auto [width, height] = used.desc().extent;
    if (width != extent.width || height != extent.height) DARKROOM_TRY(used.resize(extent));
    render::DrawOptions draw = moment.draw;
    draw.has_grid = draw.has_grid && scene_.has_grid;
    if (is_display) draw.mip_bias = 0;
    DARKROOM_TRY(used.set(draw));
    // Its own shaders gather nothing.
    return used.prepare(snapshot_, is_display ? render::FrameJitter{} : moment.jitter);
}

Result<> SceneSource::record(VkCommandBuffer commands) {
    if (is_kept_) return {};
    Result<> done = (is_display_ ? *display_ : *linear_).record(commands);
    if (!done) drawn_.reset();
    return done;
}

darkroom::Frame SceneSource::frame() const {
    darkroom::Frame frame = as_reusable(linear_->frame());
    frame.camera = as_stored(frame.camera);
    return frame;
}

darkroom::CompileDesc SceneSource::compile_desc(VkExtent2D most) const {
    darkroom::CompileDesc desc = darkroom::compile_desc_for(
        device_,
        darkroom::DeviceFrame{.frame = linear_->frame(),
                              .color_usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT,
                              .layer_usage = linear_->layer_usage()},
        {});
    desc.max_extent = most;
    return desc;
}

std::optional<darkroom::ImageRef> SceneSource::display_picture() const {
    return is_display_ ? std::optional(display_->picture()) : std::nullopt;
}

std::vector<std::filesystem::path> SceneSource::files() const {
    std::vector<std::filesystem::path> out{file_};
    std::ranges::copy(assets_.files, std::back_inserter(out));
    return out;
}

}  // namespace app
