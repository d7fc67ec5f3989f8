// SPDX-License-Identifier: MIT
#include "develop/inspect/inspector.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include "compose/stack/stack_program.hpp"
#include "core/assert.hpp"
#include "develop/stack_copy.hpp"
#include "develop/upload.hpp"
#include "gpu/device/context.hpp"
#include "gpu/resource/formats.hpp"
#include "gpu/resource/resources.hpp"
#include "plan/frame/color.hpp"

namespace darkroom {

namespace {

constexpr VkFormat value_format = VK_FORMAT_R32G32B32A32_SFLOAT;
constexpr std::uint32_t max_layers = 256;  ///< of an image, on every device
constexpr std::uint32_t ids_of_a_stack = 4096;

VkImageUsageFlags target_usage(const gpu::Context& context) {
    return context.supports(value_format, VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT)
               ? VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT
               : VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
}

/// A texel for every value that is looked at: layers of images of 1x1.
struct Texels {
    std::vector<gpu::Image> images;

    [[nodiscard]] static Result<std::shared_ptr<const Texels>> create(gpu::Context& context, std::uint32_t count) {
        auto out = std::make_shared<Texels>();
        for (std::uint32_t first = 0; first < count; first += max_layers) {
            // An image of one layer has no views of layers.
            DARKROOM_TRY_VALUE(
                auto image,
                gpu::Image::create(context, {.name = "inspected values",
                                             .format = value_format,
                                             .array_layers = std::clamp(count - first, 2U, max_layers),
                                             .usage = target_usage(context) | VK_IMAGE_USAGE_TRANSFER_SRC_BIT}));
            out->images.push_back(std::move(image));
        }
        return std::shared_ptr<const Texels>(std::move(out));
    }
    [[nodiscard]] VkDeviceSize bytes() const { return images.size() * max_layers * sizeof(PixelValue); }
    [[nodiscard]] ImageRef at(std::uint32_t number) const {
        const gpu::Image& image = images[number / max_layers];
        const std::uint32_t layer = number % max_layers;
        ImageRef out = reference_to(image, VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_LAYOUT_GENERAL);
        out.view = image.layer_views[layer];
        out.array_layer = layer;
        out.layer_count = 1;
        return out;
    }
    void record_start(const gpu::Context& context, VkCommandBuffer commands) const {
        for (const gpu::Image& image : images)
            gpu::transition(context, commands, image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL);
    }
    void record_copy(const gpu::Context& context, VkCommandBuffer commands, VkBuffer buffer) const {
        for (std::size_t i = 0; i < images.size(); ++i) {
            const gpu::Image& image = images[i];
            const VkBufferImageCopy copy{.bufferOffset = i * max_layers * sizeof(PixelValue),
                                         .imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, image.info.array_layers},
                                         .imageExtent = {1, 1, 1}};
            gpu::transition(context, commands, image, VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
            context.vk.CmdCopyImageToBuffer(commands, image.handle, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, buffer, 1,
                                            &copy);
            gpu::transition(context, commands, image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, VK_IMAGE_LAYOUT_GENERAL);
        }
    }
};

/// What is known of an entry when it is recorded, and where its `before` is: texels of a pixel, 0 the scene.
struct Recorded {
    InspectedEntry entry;
    std::optional<std::uint32_t> input;
};

struct Slot {
    std::uint64_t number = 0;  ///< 0: nothing was recorded
    std::shared_ptr<const Texels> texels;
    gpu::Buffer buffer;
    std::vector<Recorded> entries;
    Inspection inspection;  ///< without values
};

void note_change(InspectedEntry& entry) {
    for (std::size_t c = 0; c < 4; ++c) {
        const double from = double{(*entry.before)[c]}, to = double{entry.after[c]}, by = std::abs(to - from);
        if (to == from) continue;
        const bool is_known = std::isfinite(by);
        constexpr double infinity = std::numeric_limits<double>::infinity();
        entry.change = std::max(entry.change, is_known ? by : infinity);
        entry.relative_change = std::max(entry.relative_change, is_known && from != 0 ? by / std::abs(from) : infinity);
    }
}

/// All that one composer is told of the other's frame.
bool is_same(const CompileDesc& a, const CompileDesc& b) {
    return compose::facts_of(a) == compose::facts_of(b) && a.views == b.views &&
           a.max_extent.width == b.max_extent.width && a.max_extent.height == b.max_extent.height;
}

}  // namespace

bool is_finite(const PixelValue& value) {
    return std::ranges::all_of(value, [](float channel) { return std::isfinite(channel); });
}

struct Inspector::State {
    State(const Device& device, const InspectorDesc& inspector_desc)
        : context(device.shared_context()),
          desc(inspector_desc),
          composer(device, {.frames_in_flight = std::max(1U, inspector_desc.frames_in_flight)}),
          slots(std::max(1U, inspector_desc.frames_in_flight)) {}

    /// Values a pixel: the scene, then the entries.
    [[nodiscard]] std::uint32_t values() const { return static_cast<std::uint32_t>(stack.entries().size() + 1); }
    [[nodiscard]] Handle watched(std::uint32_t value) const {
        return value == 0 ? scene_color : stack.entries()[value - 1].copy;
    }
    [[nodiscard]] std::uint32_t id_of(std::uint32_t pixel, std::uint32_t value) const {
        return first_id + pixel * values() + value;
    }
    [[nodiscard]] std::uint32_t view_id(std::uint32_t value) const { return id_of(desc.max_pixels, value); }

    [[nodiscard]] CompileDesc compile_desc() const;
    [[nodiscard]] Result<> make_images();
    [[nodiscard]] Result<> start_compile();
    [[nodiscard]] Recorded describe(std::size_t index, const Frame& frame) const;
    void describe_entries(const Frame& frame, std::vector<Recorded>& out) const;
    [[nodiscard]] Result<> prepare(Slot& slot) const;
    void add_watched(const Slot& slot, std::span<const VkOffset2D> pixels, std::span<const InspectorView> views);
    [[nodiscard]] ImageRef own_target(const Frame& frame) const;

    std::shared_ptr<gpu::Context> context;
    InspectorDesc desc;
    Composer composer;
    StackCopy stack;
    std::optional<CompileDesc> source_desc;
    std::uint32_t first_id = 0;
    bool is_compiling = false;  ///< update() began something that wait() has not waited for
    std::shared_ptr<const Texels> texels;
    std::shared_ptr<const gpu::Image> target;
    std::vector<std::shared_ptr<const gpu::Image>> old_targets;  ///< per slot
    std::vector<Slot> slots;
    std::uint64_t recordings = 0;
    std::vector<Watched> wanted;
};

CompileDesc Inspector::State::compile_desc() const {
    CompileDesc out = *source_desc;
    out.fuse = false;
    out.intermediate = value_format;
    // Where no interface has to be as large as the target, the picture at the end is of no interest.
    if (out.ui.format == VK_FORMAT_UNDEFINED) out.target_extent = {1, 1};
    out.target_domain = plan::target_domain(*source_desc);
    out.target = {value_format, target_usage(*context)};
    out.watches.clear();
    for (std::uint32_t pixel = 0; pixel < desc.max_pixels; ++pixel)
        for (std::uint32_t value = 0; value < values(); ++value)
            out.watches.push_back({.id = id_of(pixel, value), .entry = watched(value), .target = out.target});
    if (desc.view.format != VK_FORMAT_UNDEFINED)
        for (std::uint32_t value = 0; value < values(); ++value)
            out.watches.push_back({.id = view_id(value), .entry = watched(value), .target = desc.view});
    return out;
}

Result<> Inspector::State::make_images() {
    DARKROOM_TRY_VALUE(texels, Texels::create(*context, values() * desc.max_pixels));
    const CompileDesc wanted_desc = compile_desc();
    const VkExtent2D extent = wanted_desc.target_extent.width != 0 ? wanted_desc.target_extent : wanted_desc.max_extent;
    DARKROOM_TRY_VALUE(auto image, gpu::Image::create(*context, {.name = "inspector's target",
                                                                 .format = value_format,
                                                                 .extent = {extent.width, extent.height, 1},
                                                                 .usage = target_usage(*context)}));
    target = std::make_shared<const gpu::Image>(std::move(image));
    return {};
}

Result<> Inspector::State::start_compile() {
    first_id += ids_of_a_stack;
    is_compiling = true;
    DARKROOM_TRY(make_images());
    return composer.compile_later(compile_desc());
}

Inspector::Inspector(const Device& device, const InspectorDesc& desc) : state_(std::make_unique<State>(device, desc)) {}
Inspector::Inspector(Inspector&&) noexcept = default;
Inspector& Inspector::operator=(Inspector&&) noexcept = default;
Inspector::~Inspector() = default;

Result<> Inspector::update(const Composer& source, const CompileDesc& compiled, const Frame& frame) {
    State& state = *state_;
    DARKROOM_TRY_VALUE(auto is_edited, state.stack.follow(source, state.composer, frame.time, frame.camera));
    if (!is_edited && state.source_desc && is_same(*state.source_desc, compiled)) return {};
    state.source_desc = compiled;
    return state.start_compile();
}

Result<> Inspector::wait() {
    if (!std::exchange(state_->is_compiling, false)) return {};
    DARKROOM_TRY(state_->composer.compile(state_->compile_desc()));
    state_->composer.wait_for_kernels();
    return {};
}

/// All but the values.
Recorded Inspector::State::describe(std::size_t index, const Frame& frame) const {
    const auto [source, handle] = stack.entries()[index];
    const EffectInfo& info = *composer.info(handle);
    const EntryDesc& entry = *composer.desc(handle);
    Recorded out{.entry = {.entry = source, .name = entry.name, .effect = std::string(info.name), .is_ui = entry.is_ui},
                 .input = {}};
    InspectedEntry& shown = out.entry;
    const Plan& plan = *composer.current_plan();
    const std::string own_image = shown.name + ".", own_reason = shown.name + ": ";
    // An effect whose end is pointwise may have passes before it, which leave images.
    shown.has_neighbours =
        info.touch != Touch::Pointwise || std::ranges::any_of(plan.images, [&](const PlanImage& image) {
            return image.name.starts_with(own_image) && image.name != own_image + "output";
        });
    if (composer.watch_state(id_of(0, static_cast<std::uint32_t>(index + 1))) == WatchState::Shown) return out;
    shown.presence = EntryPresence::Off;
    const Composer::EntryValues values = composer.values_at(handle, frame.time, frame.camera);
    shown.why = !values.is_enabled    ? "switched off"
                : values.opacity == 0 ? "its opacity is 0"
                                      : "its values change nothing";
    for (const std::string& reason : plan.left_out) {
        if (!reason.starts_with(own_reason)) continue;
        shown.presence = EntryPresence::LeftOut;
        shown.why = reason.substr(own_reason.size());
    }
    return out;
}

void Inspector::State::describe_entries(const Frame& frame, std::vector<Recorded>& out) const {
    out.clear();
    const auto pairs = stack.entries();
    const auto texel_of = [&](const Handle& wire) -> std::optional<std::uint32_t> {
        if (wire == scene_color) return 0;
        const auto found = std::ranges::find(pairs, wire, &StackCopy::Pair::copy);
        if (found == pairs.end()) return std::nullopt;
        return static_cast<std::uint32_t>(found - pairs.begin() + 1);
    };
    std::array<std::optional<std::uint32_t>, 2> last{0, std::nullopt};  // of the picture and of the interface
    std::vector<Domain> domains{Domain::SceneLinear};                   // by texel
    for (std::uint32_t i = 0; i < pairs.size(); ++i) {
        Recorded& made = out.emplace_back(describe(i, frame));
        const EntryDesc& entry = *composer.desc(pairs[i].copy);
        made.input = entry.input.is_given() ? texel_of(entry.input) : last[entry.is_ui ? 1 : 0];
        if (made.input) made.entry.input = *made.input == 0 ? "scene" : out[*made.input - 1].entry.name;
        const bool starts_ui = entry.is_ui || entry.input == ui_layer;
        Domain domain = made.input ? domains[*made.input] : starts_ui ? Domain::Encoded : Domain::SceneLinear;
        const EffectInfo& info = *composer.info(pairs[i].copy);
        if (made.entry.presence == EntryPresence::On && info.makes != nullptr)
            domain =
                info.makes({.domain = domain}, composer.values_at(pairs[i].copy, frame.time, frame.camera).words.data())
                    .domain;
        domains.push_back(made.entry.domain = domain);
        last[entry.is_ui ? 1 : 0] = i + 1;
    }
}

/// A buffer that holds its values.
Result<> Inspector::State::prepare(Slot& slot) const {
    slot.texels = texels;
    slot.number = 0;
    if (slot.buffer.memory.size >= texels->bytes()) return {};
    DARKROOM_TRY_VALUE(slot.buffer, gpu::Buffer::create(*context, texels->bytes(), VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                                        gpu::Memory::Kind::Readback, "inspected values"));
    return {};
}

void Inspector::State::add_watched(const Slot& slot, std::span<const VkOffset2D> pixels,
                                   std::span<const InspectorView> views) {
    wanted.clear();
    for (std::uint32_t pixel = 0; pixel < pixels.size(); ++pixel)
        for (std::uint32_t value = 0; value < values(); ++value)
            wanted.push_back({.id = id_of(pixel, value),
                              .region = {pixels[pixel], {1, 1}},
                              .target = slot.texels->at(pixel * values() + value)});
    for (const InspectorView& view : views)
        for (std::uint32_t value = 0; value < values(); ++value) {
            const Handle source = value == 0 ? scene_color : stack.entries()[value - 1].source;
            if (source == view.entry)
                wanted.push_back({.id = view_id(value), .region = view.region, .target = view.target});
        }
}

ImageRef Inspector::State::own_target(const Frame& frame) const {
    ImageRef out = reference_to(*target, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL);
    if (source_desc->ui.format == VK_FORMAT_UNDEFINED) return out;
    const ImageRef& like = frame.target.is_given() ? frame.target : frame.color;
    out.region = {{}, like.used_region().extent};
    return out;
}

Result<std::uint64_t> Inspector::record(VkCommandBuffer commands, const Composer& source, const Frame& frame,
                                        std::span<const VkOffset2D> pixels, std::span<const InspectorView> views) {
    State& state = *state_;
    if (!state.source_desc) return user_error("inspector: update() comes before record()");
    if (pixels.size() > state.desc.max_pixels)
        return user_error(
            fmt::format("inspector: {} pixels: allowed are at most {}", pixels.size(), state.desc.max_pixels));
    DARKROOM_TRY(state.stack.follow_values(source, state.composer, frame.time, frame.camera));
    Slot& slot = state.slots[state.recordings % state.slots.size()];
    DARKROOM_TRY(state.prepare(slot));
    state.old_targets.resize(state.slots.size());
    state.old_targets[state.recordings % state.slots.size()] = state.target;
    state.add_watched(slot, pixels, views);
    Frame own = frame;
    own.target = state.own_target(frame);
    own.watched = state.wanted;
    const bool is_compiling = state.composer.pending().is_pending;
    slot.texels->record_start(*state.context, commands);
    const Result<> recorded = state.composer.record(commands, own);
    ++state.recordings;
    // A plan that is not there yet, or was made for other frames, gives no result.
    if (!recorded && !is_compiling) return failure(recorded.error());
    if (!recorded || state.composer.watch_state(state.id_of(0, 0)) == WatchState::NotInPlan) return state.recordings;
    slot.texels->record_copy(*state.context, commands, slot.buffer.handle);
    state.describe_entries(frame, slot.entries);
    slot.inspection = {.frame_index = frame.frame_index, .time = frame.time, .pixels = {}};
    for (const VkOffset2D& pixel : pixels) slot.inspection.pixels.push_back({.at = pixel});
    slot.number = state.recordings;
    return state.recordings;
}

void Inspector::abandon() {
    if (state_->recordings == 0 || !state_->composer.abandon()) return;
    --state_->recordings;
}

std::optional<Inspection> Inspector::result(std::uint64_t recording) const {
    const State& state = *state_;
    if (recording == 0) return std::nullopt;
    const Slot& slot = state.slots[(recording - 1) % state.slots.size()];
    if (slot.number != recording) return std::nullopt;
    Inspection out = slot.inspection;
    const std::size_t values = slot.entries.size() + 1;
    for (std::size_t i = 0; i < out.pixels.size(); ++i) {
        InspectedPixel& pixel = out.pixels[i];
        const auto value = [&](std::size_t number) {
            PixelValue read{};
            std::memcpy(read.data(), slot.buffer.memory.mapped + (i * values + number) * sizeof read, sizeof read);
            return read;
        };
        pixel.scene = value(0);
        for (std::size_t k = 0; k < slot.entries.size(); ++k) {
            InspectedEntry& entry = pixel.entries.emplace_back(slot.entries[k].entry);
            entry.after = value(k + 1);
            if (!slot.entries[k].input) continue;
            entry.before = value(*slot.entries[k].input);
            note_change(entry);
            if (!pixel.born && is_finite(*entry.before) && !is_finite(entry.after)) pixel.born = k;
        }
    }
    return out;
}

std::optional<Error> Inspector::error() const { return state_->composer.pending().error; }

namespace {

constexpr ImageUse view_use{VK_FORMAT_R32G32B32A32_SFLOAT, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT};

/// Of `rgba`, the pixels that are not finite; `entry` is left to the caller.
std::optional<NonFiniteBirth> non_finite(std::span<const float> rgba, VkExtent2D extent, VkOffset2D from) {
    std::optional<NonFiniteBirth> out;
    std::int64_t nearest = 0;
    for (std::uint32_t i = 0; i < rgba.size() / 4; ++i) {
        if (std::ranges::all_of(rgba.subspan(std::size_t{i} * 4, 4), [](float v) { return std::isfinite(v); }))
            continue;
        const VkOffset2D at{static_cast<std::int32_t>(i % extent.width), static_cast<std::int32_t>(i / extent.width)};
        const std::int64_t x = at.x - from.x, y = at.y - from.y, distance = x * x + y * y;
        if (!out || distance < nearest) {
            nearest = distance;
            out = NonFiniteBirth{.at = at, .pixels = out ? out->pixels : 0};
        }
        ++out->pixels;
    }
    return out;
}

}  // namespace

struct Prober::State {
    State(Device& on, const DevelopDesc& develop, std::uint32_t max_pixels)
        : device(on),
          desc(develop),
          inspector(on, {.frames_in_flight = 1, .max_pixels = max_pixels, .view = view_use}) {}

    /// Uploads, records and waits; `view`, if it is given, is read back.
    Result<Inspection> run(const Composer& composer, const DevelopInput& input, std::span<const VkOffset2D> pixels,
                           std::span<const InspectorView> views, const Readback* view) {
        gpu::Context& context = device.context();
        const UploadLayers layers = layers_of(input);
        upload.reset();
        DARKROOM_TRY(upload.prepare(context, input, layers));
        const Frame frame = upload.frame(input);
        DARKROOM_TRY(inspector.update(composer, compile_desc_for(device, input, desc), frame));
        DARKROOM_TRY(inspector.wait());
        Result<std::uint64_t> number = 0;
        auto done = gpu::submit_and_wait(context, "probing a picture", [&](VkCommandBuffer commands) {
            upload.record(context, commands);
            number = inspector.record(commands, composer, frame, pixels, views);
            if (number && view != nullptr) view->record(commands);
        });
        if (!number) return failure(number.error());
        if (!done) return failure(std::move(done));
        std::optional<Inspection> result = inspector.result(*number);
        DARKROOM_ASSERT(result.has_value());
        return std::move(*result);
    }

    Device& device;
    DevelopDesc desc;
    FrameUpload upload;
    Inspector inspector;
};

Prober::Prober(Device& device, const DevelopDesc& desc, std::uint32_t max_pixels)
    : state_(std::make_unique<State>(device, desc, max_pixels)) {}
Prober::Prober(Prober&&) noexcept = default;
Prober& Prober::operator=(Prober&&) noexcept = default;
Prober::~Prober() = default;

/// Each is a watch for every value, and all of them together another one.
std::size_t Prober::max_pixels(const Composer& composer) {
    const std::size_t most = max_watches / (composer.size() + 1);
    return most > 1 ? most - 1 : 0;
}

Result<Inspection> Prober::probe(const Composer& composer, const DevelopInput& input,
                                 std::span<const VkOffset2D> pixels) {
    return state_->run(composer, input, pixels, {}, nullptr);
}

Result<std::optional<NonFiniteBirth>> Prober::find_birth(const Composer& composer, const DevelopInput& input,
                                                         VkOffset2D from) {
    gpu::Context& context = state_->device.context();
    DARKROOM_TRY_VALUE(auto image,
                       gpu::Image::create(context, {.name = "a probed picture",
                                                    .format = view_use.format,
                                                    .extent = {input.extent.width, input.extent.height, 1},
                                                    .usage = view_use.usage | VK_IMAGE_USAGE_TRANSFER_SRC_BIT}));
    constexpr VkImageLayout layout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
    DARKROOM_TRY_VALUE(auto readback, Readback::create(context, reference_to(image, layout, layout)));
    for (std::size_t value = 0; value <= composer.size(); ++value) {
        state_->inspector.abandon();
        const InspectorView view{.entry = value == 0 ? scene_color : composer.entry(value - 1),
                                 .target = reference_to(image, VK_IMAGE_LAYOUT_UNDEFINED, layout)};
        DARKROOM_TRY(state_->run(composer, input, {}, {&view, 1}, &readback));
        auto found = non_finite(readback.floats(4), input.extent, from);
        if (!found) continue;
        if (value > 0) found->entry = value - 1;
        return found;
    }
    return std::optional<NonFiniteBirth>{};
}

}  // namespace darkroom
