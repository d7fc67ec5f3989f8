// SPDX-License-Identifier: MIT
#include "develop/reference_chain.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <tuple>

#include "compose/chain/camera_jump.hpp"
#include "graph/graph.hpp"
#include "plan/frame/color.hpp"
#include "plan/frame_inputs.hpp"
#include "shared/blend_modes_reference.hpp"
#include "shared/color_state_reference.hpp"
#include "shared/finite_reference.hpp"
#include "shared/reading_reference.hpp"
#include "shared/srgb_reference.hpp"

namespace darkroom {

namespace {

double srgb_curve(double light) { return srgb_encoded(std::clamp(light, 0.0, 1.0)); }

bool is_there(const ReferenceChainInput& input, FrameImage image) {
    if (image == FrameImage::Shadows)
        return std::ranges::any_of(input.lights, [](const ReferenceLight& light) { return !light.cascades.empty(); });
    return input.images[image] != nullptr;
}

// As shared/merge.glsl has it.
Rgba merged(const Rgba& base, const Rgba& layer, double opacity, BlendMode mode) {
    Rgba blended = mode == BlendMode::Mix ? layer : blend_reference(base, layer, mode);
    blended.a = layer.a;
    if (opacity == 1) return blended;
    const auto mix = [&](double a, double b) { return a * (1 - opacity) + b * opacity; };
    return {mix(base.r, blended.r), mix(base.g, blended.g), mix(base.b, blended.b), mix(base.a, blended.a)};
}

double mask_weight(const Rgba& mask) {
    return std::clamp(0.2126 * mask.r + 0.7152 * mask.g + 0.0722 * mask.b, 0.0, 1.0);
}

class Chain {
  public:
    Chain(const Composer& composer, const ReferenceChainInput& input) : composer_(composer), input_(input) {}

    Result<ReferenceChainOutput> run() {
        begin_histories();
        pictures_.push_back(*input_.color);
        ReferenceImage& alpha = pictures_.emplace_back(*input_.color);
        for (Rgba& pixel : alpha.pixels) {
            const double grey = std::clamp(pixel.a, 0.0, 1.0);
            pixel = {grey, grey, grey, 1};
        }
        states_.assign(2, scene_state());
        pictures_.push_back(ui_ != nullptr ? *ui_ : ReferenceImage());
        states_.push_back(srgb_color);
        sizes_ = {{}, {}, frame_output()};
        for (std::size_t i = 0; i < composer_.size(); ++i) DARKROOM_TRY(add(i));
        if (input_.histories != nullptr) {
            input_.histories->entries = std::move(histories_);
            input_.histories->sizes = std::move(history_sizes_);
            input_.histories->outputs = outputs_read_later();
        }
        std::size_t last = value_of({}, composer_.size());
        if (input_.target_extent.width != 0) last = at_size(last, frame_output());
        ReferenceChainOutput out{.picture = pictures_[last], .left_out = std::move(left_out_)};
        finish(out.picture, states_[last]);
        return out;
    }

  private:
    ColorState scene_state() const {
        return {.white_nits = input_.target_color ? input_.target_color->white_nits : ColorState{}.white_nits};
    }
    Domain target_domain() const { return input_.target_color ? input_.target_color->domain : input_.target_domain; }
    static double alpha_of(const Rgba& p) { return p.a > 0 && p.a < 1 ? p.a : 1; }
    static ReferenceImage alpha_divided(ReferenceImage picture) {
        for (Rgba& p : picture.pixels) p = {p.r / alpha_of(p), p.g / alpha_of(p), p.b / alpha_of(p), p.a};
        return picture;
    }
    static ReferenceImage alpha_multiplied(ReferenceImage picture) {
        for (Rgba& p : picture.pixels) p = {p.r * alpha_of(p), p.g * alpha_of(p), p.b * alpha_of(p), p.a};
        return picture;
    }
    void finish(ReferenceImage& picture, const ColorState& state) const {
        const bool before = input_.is_color_associated;
        if (before) picture = alpha_divided(std::move(picture));
        convert(picture, state);
        if (input_.target_color ? input_.target_color->is_associated : before)
            picture = alpha_multiplied(std::move(picture));
    }
    void convert(ReferenceImage& picture, const ColorState& state) const {
        if (!input_.target_color) {
            if (target_domain() == Domain::Encoded && state.domain != Domain::Encoded && input_.encodes_target)
                for (Rgba& pixel : picture.pixels)
                    pixel = {srgb_curve(pixel.r), srgb_curve(pixel.g), srgb_curve(pixel.b), pixel.a};
            return;
        }
        const ColorState& target = *input_.target_color;
        const bool is_same = state.transfer == target.transfer && state.primaries == target.primaries &&
                             state.unit_nits() == target.unit_nits();
        if (is_same) return;
        for (Rgba& p : picture.pixels) {
            const std::array light{finite_reference(p.r), finite_reference(p.g), finite_reference(p.b)};
            std::array<double, 3> v = numbers_of(nits_of(light, state), target);
            if (target.transfer == Transfer::Srgb)
                for (double& x : v) x = std::clamp(x, 0.0, 1.0);
            p = {v[0], v[1], v[2], p.a};
        }
    }

    /// What is left of the frame before is nothing after a cut, as on the GPU.
    void begin_histories() {
        if (input_.histories == nullptr) return;
        ReferenceHistories& kept = *input_.histories;
        const bool is_first = kept.camera == Matrix{};
        input_.camera.is_cut |= !is_first && compose::is_camera_jump(kept.camera, input_.camera);
        if (is_first || input_.camera.is_cut || !(seconds_between_frames(input_.delta_time) > 0)) {
            kept.entries.clear();
            kept.outputs.clear();
        }
        kept.camera = input_.camera.view;
    }

    /// Those of entries that are off in this frame, or get a picture of another size, are dropped. Null: a frame by
    /// itself.
    ReferenceHistory* history_of(Handle handle, const ReferenceImage& picture) {
        if (input_.histories == nullptr) return nullptr;
        const std::pair size(picture.width, picture.height);
        const auto last = input_.histories->sizes.find(handle.id);
        if (last != input_.histories->sizes.end() && last->second != size) input_.histories->entries.erase(handle.id);
        history_sizes_[handle.id] = size;
        return &(histories_[handle.id] = std::move(input_.histories->entries[handle.id]));
    }

    /// size() if it is no entry of the stack.
    std::size_t index_of(Handle handle) const {
        std::size_t index = 0;
        while (index < composer_.size() && composer_.entry(index) != handle) ++index;
        return index;
    }

    std::size_t value_of(Handle handle, std::size_t entry) {
        if (handle == scene_color) return 0;
        if (handle == scene_alpha) return 1;
        if (handle == ui_layer) return 2;
        if (!handle.is_given()) return value_of(before(entry, is_ui(entry)), entry);
        if (handle.is_previous) return keep(before(handle));
        if (const auto* const given = find_resource<ResourceImage>(&composer_.resources(), {handle.id}))
            return keep(picture_of(*given));
        return values_[index_of(handle)];
    }
    bool is_ui(std::size_t entry) const {
        return entry < composer_.size() && composer_.desc(composer_.entry(entry))->is_ui;
    }
    /// What an entry in this place of a chain gets by default.
    Handle before(std::size_t entry, bool of_ui) const {
        while (entry-- > 0)
            if (is_ui(entry) == of_ui) return composer_.entry(entry);
        return of_ui ? ui_layer : scene_color;
    }
    Handle second_of(std::size_t entry) const {
        const EffectInfo& info = *composer_.info(composer_.entry(entry));
        const EntryDesc& desc = *composer_.desc(composer_.entry(entry));
        return desc.second.is_given() || !info.joins_ui() ? desc.second : before(entry, true);
    }
    /// Does it name an interface that is not there, or what would be made of one?
    bool is_missing(Handle wire, std::size_t entry) const {
        if (ui_ != nullptr) return false;
        const std::size_t from = wire.is_given() && !wire.is_previous ? index_of(wire) : entry;
        return wire == ui_layer || (from < entry && is_missing_[from]);
    }
    bool is_known(Handle wire, std::size_t index) const {
        if (!wire.is_given() || wire == scene_color || wire == scene_alpha || wire == scene_color.previous() ||
            wire == ui_layer)
            return true;
        if (wire.is_previous) return index_of({wire.id}) < composer_.size();
        return index_of(wire) < index || find_resource(&composer_.resources(), {wire.id}) != nullptr;
    }

    /// What the frame before had there: nothing, where there was none.
    ReferenceImage before(Handle handle) const {
        if (input_.histories != nullptr)
            if (const auto found = input_.histories->outputs.find(handle.id); found != input_.histories->outputs.end())
                return found->second;
        return ReferenceImage(input_.color->width, input_.color->height, {0, 0, 0, 0});
    }
    std::map<std::uint32_t, ReferenceImage> outputs_read_later() const {
        std::map<std::uint32_t, ReferenceImage> out;
        for (std::size_t i = 0; i < composer_.size(); ++i) {
            const EntryDesc& desc = *composer_.desc(composer_.entry(i));
            for (const Handle wire : {desc.input, desc.source, desc.second, desc.mask})
                if (wire.is_previous)
                    out[wire.id] = pictures_[wire.id == scene_color.id ? 0 : values_[index_of({wire.id})]];
        }
        return out;
    }
    static ReferenceImage picture_of(const ResourceImage& given) {
        ReferenceImage out(given.width, given.height);
        for (std::size_t i = 0; i < out.pixels.size(); ++i)
            out.pixels[i] = {given.rgba[4 * i], given.rgba[4 * i + 1], given.rgba[4 * i + 2], given.rgba[4 * i + 3]};
        return out;
    }

    std::size_t keep(ReferenceImage image) {
        pictures_.push_back(std::move(image));
        states_.push_back(scene_state());
        const ReferenceImage& kept = pictures_.back();
        sizes_.push_back({.width = kept.width, .height = kept.height});
        return pictures_.size() - 1;
    }
    std::size_t keep(ReferenceImage image, graph::Size size) {
        const std::size_t made = keep(std::move(image));
        sizes_[made] = size;
        return made;
    }
    /// By one bilinear tap a pixel, as kernels read pictures of another size.
    std::size_t at_size(std::size_t picture, graph::Size size) {
        const ReferenceImage& from = pictures_[picture];
        const auto [width, height] = size.of(extents());
        if (from.width == width && from.height == height) return picture;
        ReferenceImage out(width, height);
        for (std::uint32_t y = 0; y < height; ++y)
            for (std::uint32_t x = 0; x < width; ++x)
                out.at(x, y) = sample_reference(from, (x + 0.5) / width, (y + 0.5) / height);
        const ColorState state = states_[picture];
        const std::size_t made = keep(std::move(out), size);
        states_[made] = state;
        return made;
    }
    graph::Extents extents() const {
        const VkExtent2D scene{input_.color->width, input_.color->height};
        return {scene, input_.target_extent.width != 0 ? input_.target_extent : scene};
    }
    graph::Size frame_output() const {
        return {.extent = input_.target_extent.width != 0 ? graph::Extent::Output : graph::Extent::Scene};
    }
    /// What the frame brings, for a picture of this size: see plan::FrameInput.
    const ReferenceImage* input_at(const plan::FrameInput& input, const ReferenceImage& like) {
        const ReferenceImage* const image = input_.images[input.image];
        const bool is_as_large = image != nullptr && image->width == like.width && image->height == like.height;
        if (image == nullptr || is_as_large || input.extent == plan::InputExtent::Texel) return image;
        const auto [found, is_new] = resampled_.try_emplace({input.image, like.width, like.height});
        if (is_new) found->second = plan::resampled_reference(*image, input, like.width, like.height);
        return &found->second;
    }
    /// The picture that an entry gets, at the size it works at.
    std::size_t input_of(const EntryDesc& desc, std::size_t index) {
        std::size_t from = value_of(desc.input, index);
        if (desc.input.is_previous) from = at_size(from, {});
        return at_size(from, sizes_[from].scaled(desc.scale.numerator, desc.scale.denominator));
    }

    Result<> add(std::size_t index) {
        const Handle handle = composer_.entry(index);
        const EffectInfo& info = *composer_.info(handle);
        const auto [words, is_enabled, opacity] = composer_.values_at(handle, input_.time, input_.camera);
        EntryDesc desc = *composer_.desc(handle);
        desc.enabled = is_enabled;
        desc.opacity = opacity;
        for (const Handle wire : {desc.input, desc.source, desc.second, desc.mask})
            if (!is_known(wire, index))
                return user_error(
                    fmt::format("stack entry '{}': it reads what is not the output of an earlier entry", desc.name));
        values_.push_back(value_of(desc.input, index));
        is_missing_.push_back(is_missing(desc.input.is_given() ? desc.input : before(index, desc.is_ui), index));
        Needs needs = info.needs;
        if (is_missing_.back()) needs.add(FrameImage::Ui);
        for (const Handle wire : {desc.source, second_of(index), desc.mask})
            if (is_missing(wire, index)) needs.add(FrameImage::Ui);
        std::string why = plan::missing_needs(needs, [&](FrameImage image) { return is_there(input_, image); });
        if (!why.empty()) why = fmt::format("needs {}, which the frame does not have", why);
        if (why.empty() && info.is_last_step && target_domain() == Domain::SceneLinear)
            why = "the target takes scene-linear floats";
        if (!why.empty()) {
            left_out_.push_back(fmt::format("{}: {}", desc.name, why));
            is_left_out_.push_back(true);
            return {};
        }
        is_left_out_.push_back(false);
        if (info.has_second() && !second_of(index).is_given())
            return user_error(fmt::format("stack entry '{}': {} reads two pictures: name the other one as `second`",
                                          desc.name, info.name));
        const std::size_t from = input_of(desc, index);
        const ColorState before = states_[from];
        const bool lacks_perspective = info.needs.perspective && !plan::has_perspective(input_.camera);
        if (lacks_perspective) left_out_.push_back(fmt::format("{}: {}", desc.name, plan::lacks_perspective_reason));
        const bool is_off = !desc.enabled || desc.opacity <= 0 || lacks_perspective ||
                            (info.is_identity != nullptr && info.is_identity(words.data()));
        if (!is_off && !info.reference)
            return user_error(fmt::format("stack entry '{}': {} has no reference", desc.name, info.name));
        const bool is_reading = info.reference.is_reading() && is_plain(desc);
        if (is_reading)
            values_.back() = read_on(info, words, from, is_off);
        else
            values_.back() = keep_result(info, desc, words, index, from, is_off);
        states_.back() = is_off || info.makes == nullptr ? before : info.makes(before, words.data());
        return {};
    }

    /// What an entry that is off hands on has the size of its result.
    std::size_t keep_result(const EffectInfo& info, const EntryDesc& desc, const std::vector<std::uint32_t>& words,
                            std::size_t index, std::size_t from, bool is_off) {
        const bool has_result = info.touch == Touch::Neighbourhood || info.touch == Touch::History;
        const ResultScale& scale = info.output_scale;
        const graph::Size size =
            has_result ? (scale.is_of_output ? frame_output() : sizes_[from]).scaled(scale.numerator, scale.denominator)
                       : sizes_[from];
        if (is_off) return keep(pictures_[at_size(from, size)], size);
        const bool is_wrapped = plan::may_need_work(info, states_[from].domain == Domain::Encoded, desc.is_ui);
        if (info.works.in == WorkingSpace::Light ||
            !plan::maps_without_alpha(info, is_wrapped, input_.is_color_associated && !desc.is_ui))
            return keep(encoded_result(info, desc, words, index, from), size);
        const ColorState state = states_[from];
        from = keep(alpha_divided(pictures_[from]), sizes_[from]);
        states_[from] = state;
        return keep(alpha_multiplied(encoded_result(info, desc, words, index, from)), size);
    }

    static bool is_plain(const EntryDesc& desc) {
        return desc.opacity == 1 && desc.blend == BlendMode::Mix && !desc.mask.is_given();
    }

    /// A picture that is no more than a reading of another, so that maps may go on with it.
    struct Reading {
        std::size_t picture = 0;
        std::vector<std::pair<const EffectInfo*, std::vector<std::uint32_t>>> steps;
    };
    ReferenceImage picture_of(const Reading& reading, std::uint32_t width, std::uint32_t height) const {
        std::vector<ReadingStep> steps;
        for (const auto& [info, words] : reading.steps)
            steps.push_back({info->reference.map, info->reference.tap, words.data()});
        return read_reference(pictures_[reading.picture], steps, width, height);
    }
    std::size_t read_on(const EffectInfo& info, const std::vector<std::uint32_t>& words, std::size_t from,
                        bool is_off) {
        const auto found = readings_.find(from);
        Reading reading = found != readings_.end() ? found->second : Reading{from, {}};
        if (!is_off) reading.steps.emplace_back(&info, words);
        const std::size_t made =
            keep(is_off ? pictures_[from] : picture_of(reading, pictures_[from].width, pictures_[from].height),
                 sizes_[from]);
        readings_[made] = std::move(reading);
        return made;
    }

    /// The result of an entry that may want the picture as code values of sRGB.
    ReferenceImage encoded_result(const EffectInfo& info, const EntryDesc& desc,
                                  const std::vector<std::uint32_t>& words, std::size_t index, std::size_t from) {
        const ColorState state = states_[from];
        const bool may_work = plan::may_need_work(info, state.domain == Domain::Encoded, false);
        if (info.works.in == WorkingSpace::Light || !may_work || plan::work_of(info, state, words.data()).word == 0)
            return result(info, desc, words, index, from);
        const double white =
            info.works.white_nits == nullptr ? double{state.white_nits} : double{info.works.white_nits(words.data())};
        ReferenceImage encoded = pictures_[from];
        const auto curve = [](std::array<double, 3> v, auto function) {
            return std::array{function(v[0]), function(v[1]), function(v[2])};
        };
        for (Rgba& p : encoded.pixels) {
            const auto v = curve(nits_of({p.r, p.g, p.b}, state), [&](double x) { return srgb_encoded(x / white); });
            p = {v[0], v[1], v[2], p.a};
        }
        ReferenceImage out = result(info, desc, words, index, keep(std::move(encoded), sizes_[from]));
        for (Rgba& p : out.pixels) {
            const auto v = numbers_of(curve({p.r, p.g, p.b}, [&](double x) { return srgb_decoded(x) * white; }), state);
            p = {v[0], v[1], v[2], p.a};
        }
        return out;
    }

    ReferenceImage result(const EffectInfo& info, const EntryDesc& desc, const std::vector<std::uint32_t>& words,
                          std::size_t index, std::size_t from) {
        const ReferenceImage& base = pictures_[from];
        // By value: what a wire names may be kept anew, and moves them.
        const graph::Size size = sizes_[from];
        const auto wired = [&, size](Handle wire, const ReferenceImage* otherwise) {
            return wire.is_given() ? &pictures_[at_size(value_of(wire, index), size)] : otherwise;
        };
        const ReferenceImage* second = nullptr;
        if (const Handle wire = second_of(index); info.has_second()) {
            const auto reading = readings_.find(value_of(wire, index));
            const bool is_in_place = info.second == Second::InPlace && reading != readings_.end();
            second = is_in_place ? &pictures_[keep(picture_of(reading->second, base.width, base.height))]
                                 : wired(wire, nullptr);
        }
        const VkExtent2D output = frame_output().of(extents());
        ReferenceInput given{.picture = &base,
                             .source = wired(desc.source, &base),
                             .second = second,
                             .lights = input_.lights,
                             .resources = &composer_.resources(),
                             .color = states_[from],
                             .camera = input_.camera,
                             .time = input_.time,
                             .delta_time = seconds_between_frames(input_.delta_time),
                             .frame_index = input_.frame_index,
                             .output_width = output.width,
                             .output_height = output.height,
                             .history = history_of(composer_.entry(index), base)};
        given.color.is_associated = input_.is_color_associated && !desc.is_ui;
        for (const plan::FrameInput& input : plan::frame_inputs)
            if (input.reference != nullptr) given.*input.reference = input_at(input, base);
        ReferenceImage layer = info.reference(words.data(), given);
        const bool is_same_size = layer.width == base.width && layer.height == base.height;
        if (is_plain(desc) || !is_same_size) return layer;
        const ReferenceImage* const mask = wired(desc.mask, nullptr);
        for (std::size_t i = 0; i < layer.pixels.size(); ++i) {
            const double opacity = desc.opacity * (mask == nullptr ? 1.0 : mask_weight(mask->pixels[i]));
            layer.pixels[i] = merged(base.pixels[i], layer.pixels[i], opacity, desc.blend);
        }
        return layer;
    }

    const Composer& composer_;
    ReferenceChainInput input_;  ///< its camera is cut after a jump
    const ReferenceImage* const ui_ = input_.images[FrameImage::Ui];
    std::deque<ReferenceImage> pictures_;      // that none moves while others are added
    std::vector<ColorState> states_;           // of each picture
    std::vector<graph::Size> sizes_;           // of each picture
    std::vector<std::size_t> values_;          // of each entry: its picture
    std::map<std::size_t, Reading> readings_;  // of pictures that are one
    std::vector<bool> is_left_out_;            // of each entry
    std::vector<bool> is_missing_;             // of each entry: its picture is an interface that is not there
    std::vector<std::string> left_out_;
    std::map<std::uint32_t, ReferenceHistory> histories_;  // of this frame
    std::map<std::uint32_t, std::pair<std::uint32_t, std::uint32_t>> history_sizes_;
    /// What the frame brings, at other extents.
    std::map<std::tuple<FrameImage, std::uint32_t, std::uint32_t>, ReferenceImage> resampled_;
};

}  // namespace

Result<ReferenceChainOutput> run_reference(const Composer& composer, const ReferenceChainInput& input) {
    return Chain(composer, input).run();
}

std::vector<std::uint8_t> round_to_bytes(const ReferenceImage& image) {
    const auto byte = [](double v) {
        return static_cast<std::uint8_t>(std::isnan(v) ? 0.0 : std::floor(std::clamp(v, 0.0, 1.0) * 255 + 0.5));
    };
    std::vector<std::uint8_t> out;
    out.reserve(image.pixels.size() * 4);
    for (const Rgba& pixel : image.pixels)
        for (const double channel : {pixel.r, pixel.g, pixel.b, pixel.a}) out.push_back(byte(channel));
    return out;
}

}  // namespace darkroom
