// SPDX-License-Identifier: MIT
// Two Composers and one picture: the first is edited at random while it records, with compiles now and later, failed
// ones, effects of files that are saved again, other devices and recordings that are taken back; the second is compiled
// anew for every frame, with the plan that must run and the values that the entries must have. What a trail must hold,
// and the scene of the frame before, are handed to the second as pictures. Memory is filled with NaN before the library
// gets it, and a host may look at every trail.

#include <array>
#include <darkroom/custom_effect.hpp>
#include <darkroom/describe.hpp>
#include <map>
#include <memory>
#include <optional>

#include "compose/test_stacks/effects.hpp"
#include "compose/test_stacks/random_stack.hpp"
#include "compose/test_stacks/record_in_vain.hpp"
#include "core/test_support_small.hpp"
#include "gpu/device/test_host_desc.hpp"

namespace darkroom::differential {
namespace {

using test::below;
using test::must;
using test::one_in;

constexpr VkFormat float_format = VK_FORMAT_R32G32B32A32_SFLOAT;
constexpr VkExtent2D largest{24, 16};

// The trail reads what it gave in the last frame, the other one what is wired to it: the same kernel otherwise.
struct Trail {
    float unused = 0;
};
constexpr auto trail_rows = describe(field<&Trail::unused>("Nothing.", {0, 1}));
struct Handed {
    Resource before;
};
constexpr auto handed_rows = describe(field<&Handed::before>("Half of it is added."));
constexpr EffectFile trail_files[] = {
    {"handed.glsl",
     "vec4 shade(Pixel pixel) {\n"
     "    return vec4(0.5 * texelFetch(trail_before, pixel.texel, 0).rgb + load(trail_in, pixel.texel).rgb, "
     "1.0);\n}\n"},
    {"trail.glsl",
     "vec4 shade(Pixel pixel) {\n"
     "    return vec4(0.5 * load(trail_before, pixel.texel).rgb + load(trail_in, pixel.texel).rgb, 1.0);\n}\n"},
    {"still.glsl", "vec4 shade(Pixel pixel) { return texelFetch(still_picture, pixel.texel, 0); }\n"},
    {"broken.glsl", "vec4 broken(vec4 color, Pixel pixel, Broken parameters) { return oops; }\n"},
};
void build_trail(PassBuilder& builder) {
    const PassBuilder::History history = builder.history({.name = "trail", .format = float_format});
    builder.result(builder.add({.name = "trail",
                                .shader = "trail.glsl",
                                .inputs = {{.name = "trail_in", .image = builder.picture()},
                                           {.name = "trail_before", .image = history.previous}},
                                .output = history.current}));
}
KernelPassDesc::Input handed_picture(PassBuilder& builder, const char* name) {
    const auto* const parameters = static_cast<const Handed*>(builder.parameters());
    const auto& before = std::get<ResourceImage>(*builder.resource(parameters->before));
    TableDesc table{.name = "before", .format = float_format, .extent = {before.width, before.height, 1}};
    const auto bytes = std::as_bytes(std::span(before.rgba));
    table.data.assign(bytes.begin(), bytes.end());
    return {.name = name, .image = builder.table(table)};
}
void build_handed(PassBuilder& builder) {
    builder.result(builder.add(
        {.name = "trail",
         .shader = "handed.glsl",
         .inputs = {{.name = "trail_in", .image = builder.picture()}, handed_picture(builder, "trail_before")},
         .output = builder.create({.name = "trail", .format = float_format})}));
}
void build_still(PassBuilder& builder) {
    builder.result(builder.add({.name = "still",
                                .shader = "still.glsl",
                                .inputs = {handed_picture(builder, "still_picture")},
                                .output = builder.create({.name = "still", .format = float_format})}));
}
const EffectInfo trail{.name = "trail",
                       .doc = "Adds half of what it gave in the last frame.",
                       .parameters = trail_rows.table(),
                       .files = trail_files,
                       .touch = Touch::History,
                       .build = build_trail};
const EffectInfo handed{.name = "handed",
                        .doc = "Adds half of a picture.",
                        .parameters = handed_rows.table(),
                        .files = trail_files,
                        .touch = Touch::History,
                        .build = build_handed};
const EffectInfo still{.name = "still",
                       .doc = "Is a picture.",
                       .parameters = handed_rows.table(),
                       .files = trail_files,
                       .touch = Touch::History,
                       .build = build_still};
const EffectInfo broken{
    .name = "broken", .doc = "Does not compile.", .parameters = trail_rows.table(), .files = trail_files};

/// The largest difference; what is no number, or beyond all, must be the same there.
double difference(const ReferenceImage& a, const ReferenceImage& b) {
    double worst = a.pixels.size() == b.pixels.size() ? 0 : 1e9;
    for (std::size_t i = 0; i < a.pixels.size() && worst < 1e9; ++i)
        for (double Rgba::*const channel : {&Rgba::r, &Rgba::g, &Rgba::b, &Rgba::a}) {
            const double p = a.pixels[i].*channel, q = b.pixels[i].*channel;
            if (p == q || (std::isnan(p) && std::isnan(q))) continue;
            worst = std::isfinite(p) && std::isfinite(q) ? std::max(worst, std::abs(p - q)) : 1e9;
        }
    return worst;
}

/// One step of the format: where the first still shows complete kernels the second has lean ones, and a driver
/// contracts each by itself.
double step_of(VkFormat format) {
    return format == VK_FORMAT_R8G8B8A8_UNORM ? 1 / 255.0 : format == float_format ? 1e-6 : 1 / 128.0;
}

/// Of the test's device, with memory that holds NaN.
class DirtyDevice {
  public:
    DirtyDevice() : device_(adopted()) {}
    [[nodiscard]] Device& device() { return device_; }

  private:
    static Device adopted() {
        const VkPhysicalDeviceVulkan13Features features{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES,
                                                        .synchronization2 = VK_TRUE,
                                                        .dynamicRendering = VK_TRUE};
        const VkPhysicalDeviceFeatures2 all{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2,
                                            .pNext = const_cast<VkPhysicalDeviceVulkan13Features*>(&features)};
        AdoptDesc desc = gpu::test::host_desc(&all);
        desc.memory = {.allocate = allocate, .free = free};
        Device device = must(Device::adopt(desc));
        device.context().queue = gpu::test::context().queue;
        return device;
    }
    static VkResult allocate(void*, VkDevice device, const DeviceMemoryRequest* request, DeviceMemory* out) {
        const gpu::Dispatch& vk = gpu::test::context().vk;
        const VkMemoryDedicatedAllocateInfo own{.sType = VK_STRUCTURE_TYPE_MEMORY_DEDICATED_ALLOCATE_INFO,
                                                .image = request->image,
                                                .buffer = request->buffer};
        const bool is_dedicated = request->image != VK_NULL_HANDLE || request->buffer != VK_NULL_HANDLE;
        const VkMemoryAllocateInfo info{.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                        .pNext = is_dedicated ? &own : nullptr,
                                        .allocationSize = request->size,
                                        .memoryTypeIndex = request->memory_type};
        *out = {};
        if (const VkResult made = vk.AllocateMemory(device, &info, nullptr, &out->memory); made != VK_SUCCESS)
            return made;
        VkPhysicalDeviceMemoryProperties properties{};
        vk.GetPhysicalDeviceMemoryProperties(gpu::test::context().physical_device, &properties);
        // A GPU's own memory is as it comes.
        constexpr VkMemoryPropertyFlags visible = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT;
        if ((properties.memoryTypes[request->memory_type].propertyFlags & visible) == 0) return VK_SUCCESS;
        void* mapped = nullptr;
        if (const VkResult made = vk.MapMemory(device, out->memory, 0, VK_WHOLE_SIZE, 0, &mapped); made != VK_SUCCESS)
            return made;
        std::memset(mapped, 0xff, request->size);
        if (request->is_mapped) out->mapped = mapped;
        return VK_SUCCESS;
    }
    static void free(void*, VkDevice device, const DeviceMemory* memory) {
        gpu::test::context().vk.FreeMemory(device, memory->memory, nullptr);
    }
    Device device_;
};

/// An entry as the user of the first Composer knows it, from add to remove.
struct Item {
    Handle handle;
    const EffectInfo* info = nullptr;
    EntryDesc desc;
    std::vector<std::uint32_t> words;
    struct Override {
        std::string owner, row;
        std::vector<std::uint32_t> words;
    };
    std::vector<Override> overrides;
    std::vector<LayerDesc> layers;  ///< their values are of this entry
    struct Pulse {
        PulseDesc desc;
        std::optional<double> start;
        bool is_waiting = false;
    };
    std::vector<Pulse> pulses;
    std::weak_ptr<Item> replaced;  ///< of another effect under the handle

    [[nodiscard]] bool is_plain() const {
        return desc.opacity == 1 && desc.blend == BlendMode::Mix && !desc.mask.is_given();
    }
};
using ItemPointer = std::shared_ptr<Item>;

/// What the view's last recording left in a history.
struct Left {
    ReferenceImage picture;
    VkExtent2D max_extent{};
    std::uint64_t recording = 0;
};
struct LeftOfView {
    std::map<ItemPointer, Left> trails;
    Left scene;
    VkExtent2D extent{};
    std::uint64_t recordings = 0;
};

/// What a compile has made: the wires of then, and whose values they show.
struct Planned {
    struct Entry {
        ItemPointer item;
        EntryDesc wires;
        bool is_mixable = true;
    };
    std::vector<Entry> entries;
    CompileDesc desc;
};

enum class Kind : std::uint8_t {
    Sizes,   ///< entries and targets of several sizes, no histories
    Trails,  ///< histories, of several views; a frame of another extent is a cut
};

/// A user's file, as it was saved at some moment.
std::string tint_file(std::uint32_t number) {
    constexpr std::array helpers{"color.rgb * 0.5", "1.0 - color.rgb", "color.brg", "oops"};
    return fmt::format(
        "// @effect tint: Does something else each time.\n"
        "// @param float amount = 0.75 in [0, 1] amount: How much of it.\n"
        "vec3 helper(vec4 color) {{ return {}; }}\n"
        "vec4 tint(vec4 color, Pixel pixel, Tint parameters) {{\n"
        "    return vec4(mix(color.rgb, helper(color), parameters.amount), color.a);\n}}\n",
        helpers[number]);
}

class Run {
  public:
    Run(Device& device, std::uint32_t seed)
        : random_(seed * 2654435761U + 17),
          kind_(one_in(random_, 2) ? Kind::Sizes : Kind::Trails),
          host_(picture_of(seed), float_format, float_format, device),
          other_(gpu::test::upload(device.context(), test::pixels_of(picture_of(seed + 1)), float_format,
                                   VK_IMAGE_LAYOUT_GENERAL)),
          views_(kind_ == Kind::Trails ? 1 + below(random_, 3) : 1),
          has_thread_(one_in(random_, 3)),
          asks_first_(!has_thread_ && one_in(random_, 3)),
          composer_(device, {.frames_in_flight = 1 + below(random_, 2), .max_threads = has_thread_ ? 1U : 0U}),
          text_(fmt::format("seed {}, {}, {} views{}{}", seed, kind_ == Kind::Sizes ? "sizes" : "trails", views_,
                            has_thread_ ? ", a thread" : "", asks_first_ ? ", asks first" : "")) {
        for (const VkFormat format : {float_format, VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_R16G16B16A16_SFLOAT})
            for (auto* const pictures : {&targets_, &expected_})
                pictures->emplace(format, gpu::test::blank(device.context(), largest, format));
        for (std::uint32_t i = 0; i < 3; ++i) add_any(stack_.size());
        compile(true);
    }

    [[nodiscard]] const std::string& text() const { return text_; }
    [[nodiscard]] bool is_running() const { return running_.has_value(); }
    [[nodiscard]] std::uint64_t trails_that_went_on() const { return went_on_; }
    [[nodiscard]] std::uint64_t scenes_that_went_on() const { return scenes_went_on_; }
    [[nodiscard]] std::uint64_t failed_compiles() const { return failed_; }

    /// Some edits, perhaps a compile, and a frame.
    void step() {
        for (std::uint32_t i = below(random_, 4); i > 0; --i) edit();
        if (!running_ || one_in(random_, 3)) compile(!running_ || one_in(random_, 3));
        if (one_in(random_, 12)) rebind();
        if (asks_first_ && one_in(random_, 2)) {
            note("ask");
            // The first call makes a plan that is ready wait for the next one.
            asked_ = true;
            static_cast<void>(composer_.coming_plan());
            if (ready_) told_ = std::exchange(ready_, std::nullopt);
        }
        if (running_) frame();
    }

  private:
    static ReferenceImage picture_of(std::uint32_t seed) {
        ReferenceImage picture = test::random_display(largest.width, largest.height, seed);
        for (Rgba& pixel : picture.pixels) pixel = {pixel.r * 2, pixel.g * 2, pixel.b * 2, 0.25 + pixel.g / 2};
        return test::round_to_float(picture);
    }
    void note(const std::string& what) { text_ += "\n  " + what; }

    // ---- edits, of the Composer and of what is expected of it ----

    [[nodiscard]] const EffectInfo& any_effect() {
        static const std::vector<const EffectInfo*> plain = [] {
            std::vector<const EffectInfo*> out{&test::shift_effect, &test::cross_effect, &test::glow_effect,
                                               &test::recode_effect};
            for (const std::string_view name : {"exposure", "negative", "grayscale", "vignette", "dither"})
                if (const EffectInfo* const info = find_effect(name)) out.push_back(info);
            return out;
        }();
        if (one_in(random_, 24)) return broken;
        if (one_in(random_, 6)) return saved_file();
        if (one_in(random_, 3)) {
            if (kind_ == Kind::Trails) return trail;
            return test::halve_effect;
        }
        return *plain[below(random_, static_cast<std::uint32_t>(plain.size()))];
    }
    /// What the Composer gets is gone before it is compiled: a host that loads a file again keeps nothing of the old
    /// one.
    [[nodiscard]] const EffectInfo& saved_file() {
        const std::string text = tint_file(one_in(random_, 8) ? 3 : below(random_, 3));
        fresh_ = std::make_unique<CustomEffect>(must(CustomEffect::parse(text, "tint.glsl")));
        kept_.push_back(std::make_unique<CustomEffect>(must(CustomEffect::parse(text, "tint.glsl"))));
        return fresh_->info();
    }
    [[nodiscard]] const EffectInfo& lasting(const EffectInfo& info) const {
        return fresh_ && &info == &fresh_->info() ? kept_.back()->info() : info;
    }
    [[nodiscard]] Handle any_wire() {
        if (kind_ == Kind::Trails && one_in(random_, 4)) return scene_color.previous();
        const std::uint32_t pick = below(random_, static_cast<std::uint32_t>(stack_.size()) + 3);
        if (pick < 3) return std::array{Handle{}, scene_color, scene_alpha}[pick];
        return stack_[pick - 3]->handle;
    }
    /// A trail is an image of its own, that nobody lays over anything.
    [[nodiscard]] EntryDesc any_desc(const EffectInfo& info) {
        EntryDesc desc;
        if (one_in(random_, 3)) desc.input = any_wire();
        if (&info == &trail) return desc;
        if (one_in(random_, 3)) desc.source = any_wire();
        if (one_in(random_, 6)) desc.mask = any_wire();
        if (one_in(random_, 3)) desc.opacity = static_cast<float>(test::between(random_, 0, 1));
        if (one_in(random_, 5)) desc.blend = static_cast<BlendMode>(below(random_, 9));
        if (kind_ == Kind::Sizes && one_in(random_, 10)) desc.scale = {1, 2};
        return desc;
    }
    [[nodiscard]] ItemPointer any_item() {
        return stack_.empty() ? nullptr : stack_[below(random_, static_cast<std::uint32_t>(stack_.size()))];
    }
    [[nodiscard]] ItemPointer item_of(const EffectInfo& info, Handle handle) const {
        auto item = std::make_shared<Item>();
        item->handle = handle;
        item->info = &lasting(info);
        item->desc = *composer_.desc(handle);
        item->words.assign(composer_.words(handle).begin(), composer_.words(handle).end());
        return item;
    }
    void add_any(std::size_t place) {
        const EffectInfo& info = any_effect();
        const EntryDesc desc = any_desc(info);
        const Handle handle = place == stack_.size()
                                  ? composer_.add(info, nullptr, desc)
                                  : must(composer_.insert(stack_[place]->handle, info, nullptr, desc));
        stack_.insert(stack_.begin() + static_cast<std::ptrdiff_t>(place), item_of(info, handle));
        note(fmt::format("add {} at {}", composer_.desc(handle)->name, place));
        set_any(stack_[place]);
    }
    /// Values of a parameter that no pass is built by.
    [[nodiscard]] std::optional<std::pair<const ParamInfo*, std::vector<std::uint32_t>>> any_value(const Item& item) {
        if (item.info == &trail) return std::nullopt;  // who stands in for it has no such parameter
        std::vector<const ParamInfo*> rows;
        for (const ParamInfo& row : item.info->parameters.rows)
            if (!row.is_at_compile && row.words <= 4 && row.kind != ::darkroom::Kind::Resource) rows.push_back(&row);
        if (rows.empty()) return std::nullopt;
        const ParamInfo& row = *rows[below(random_, static_cast<std::uint32_t>(rows.size()))];
        std::vector<std::uint32_t> words;
        for (std::uint32_t i = 0; i < row.words; ++i) {
            if (row.kind == ::darkroom::Kind::Toggle)
                words.push_back(below(random_, 2));
            else if (row.kind == ::darkroom::Kind::Choice)
                words.push_back(below(random_, static_cast<std::uint32_t>(row.choices.size())));
            else if (row.kind == ::darkroom::Kind::Int)
                words.push_back(
                    static_cast<std::uint32_t>(std::lround(test::random_value(random_, row, test::Values::Sane))));
            else
                words.push_back(std::bit_cast<std::uint32_t>(
                    static_cast<float>(test::random_value(random_, row, test::Values::Sane))));
        }
        return std::pair(&row, words);
    }
    void set_any(const ItemPointer& item) {
        const auto value = any_value(*item);
        if (!value) return;
        const auto& [row, words] = *value;
        must(composer_.set(item->handle, row->name, words));
        std::ranges::copy(words, item->words.begin() + row->word);
        if (item->info->conflict != nullptr && !item->info->conflict(item->words.data()).empty()) {
            const auto first = item->info->parameters.defaults.subspan(row->word, row->words);
            must(composer_.set(item->handle, row->name, first));
            std::ranges::copy(first, item->words.begin() + row->word);
        }
    }
    template <class Visit>
    static void for_all_of(const ItemPointer& item, const Visit& visit) {
        for (ItemPointer one = item; one; one = one->replaced.lock()) visit(*one);
    }
    void modulate(const ItemPointer& item) {
        const auto value = any_value(*item);
        if (!value) return;
        const auto& [row, words] = *value;
        const std::string name = fmt::format("m{}", ++names_);
        const bool is_float = row->kind == ::darkroom::Kind::Float;
        switch (below(random_, 3)) {
            case 0:
                note(fmt::format("override {}.{}", item->desc.name, row->name));
                must(composer_.set_override(item->handle, row->name, name, words));
                item->overrides.push_back({name, std::string(row->name), words});
                return;
            case 1: {
                note(fmt::format("layer {} on {}.{}", name, item->desc.name, row->name));
                LayerDesc layer{.name = name,
                                .weight = static_cast<float>(test::between(random_, 0, 1)),
                                .values = {{item->handle, std::string(row->name), words}}};
                if (one_in(random_, 2)) layer.distance = LayerDistance{.near = 1, .far = 9};
                if (one_in(random_, 3)) layer.values = {{item->handle, "enabled", {below(random_, 2)}}};
                must(composer_.add_layer(layer));
                item->layers.push_back(layer);
                return;
            }
            default:
                if (!is_float) return;
                note(fmt::format("pulse on {}.{}", item->desc.name, row->name));
                const PulseDesc pulse{.event = one_in(random_, 2) ? "hit" : "flash",
                                      .entry = item->handle,
                                      .parameter = std::string(row->name),
                                      .amount = {0.5F, 0.5F, 0.5F, 0.5F},
                                      .duration = 0.1};
                must(composer_.add_pulse(pulse));
                item->pulses.push_back({pulse});
        }
    }
    void edit_modulation() {
        switch (below(random_, 4)) {
            case 0: {
                const char* const event = one_in(random_, 2) ? "hit" : "flash";
                note(fmt::format("fire {}", event));
                static_cast<void>(composer_.fire(event));
                for (const ItemPointer& item : stack_)
                    for (Item::Pulse& pulse : item->pulses) pulse.is_waiting |= pulse.desc.event == event;
                return;
            }
            case 1:
                for (const ItemPointer& item : stack_)
                    for (LayerDesc& layer : item->layers) {
                        if (one_in(random_, 2)) continue;
                        layer.weight = static_cast<float>(test::between(random_, 0, 1));
                        must(composer_.set_layer_weight(layer.name, layer.weight));
                    }
                return;
            case 2: {
                const ItemPointer item = any_item();
                if (!item || item->overrides.empty()) return;
                const std::string owner = item->overrides.front().owner;
                note("drop an override of " + item->desc.name);
                composer_.drop_overrides(owner);
                std::erase_if(item->overrides, [&](const auto& one) { return one.owner == owner; });
                return;
            }
            default: {
                const ItemPointer item = any_item();
                if (!item || item->layers.empty()) return;
                note("remove a layer of " + item->desc.name);
                composer_.remove_layer(item->layers.front().name);
                item->layers.erase(item->layers.begin());
            }
        }
    }
    void edit() {
        const ItemPointer item = any_item();
        switch (item ? below(random_, 12) : 0) {
            case 0:
                if (stack_.size() < 6) add_any(below(random_, static_cast<std::uint32_t>(stack_.size()) + 1));
                return;
            case 1:
            case 2:
                note("remove " + item->desc.name);
                must(composer_.remove(item->handle));
                std::erase(stack_, item);
                return;
            case 3: {
                const ItemPointer before = any_item();
                note(fmt::format("move {} before {}", item->desc.name, before->desc.name));
                must(composer_.move(item->handle, before->handle));
                if (before == item) return;
                std::erase(stack_, item);
                stack_.insert(std::ranges::find(stack_, before), item);
                return;
            }
            case 4:
                return replace(item);
            case 5: {
                EntryDesc desc = any_desc(*item->info);
                note("rewire " + item->desc.name);
                must(composer_.rewire(item->handle, desc));
                item->desc = *composer_.desc(item->handle);
                return;
            }
            case 6:
            case 7: {
                const bool is_enabled = one_in(random_, 2);
                note(fmt::format("{} {}", is_enabled ? "enable" : "disable", item->desc.name));
                must(composer_.set_enabled(item->handle, is_enabled));
                for_all_of(item, [&](Item& one) { one.desc.enabled = is_enabled; });
                return;
            }
            case 8: {
                constexpr std::array opacities{0.0F, 0.25F, 1.0F};
                const float opacity =
                    item->info == &trail ? static_cast<float>(below(random_, 2)) : opacities[below(random_, 3)];
                if (!composer_.set_opacity(item->handle, opacity)) return;
                note(fmt::format("opacity {} of {}", opacity, item->desc.name));
                for_all_of(item, [&](Item& one) { one.desc.opacity = opacity; });
                return;
            }
            case 9:
                return modulate(item);
            case 10:
                return edit_modulation();
            default:
                return set_any(item);
        }
    }
    void replace(const ItemPointer& item) {
        const bool is_saved_again = item->info->name == "tint" && one_in(random_, 2);
        const EffectInfo& info = is_saved_again ? saved_file() : any_effect();
        const bool was_trail = item->info == &trail, is_trail = &info == &trail;
        if (is_trail && !was_trail && !item->is_plain()) return;
        note(fmt::format("replace {} by {}", item->desc.name, info.name));
        must(composer_.replace(item->handle, info, nullptr));
        if (item->info == &info) {
            item->words.assign(info.parameters.defaults.begin(), info.parameters.defaults.end());
            return;
        }
        const ItemPointer made = item_of(info, item->handle);
        made->replaced = item;
        replaced_.push_back(item);
        *std::ranges::find(stack_, item) = made;
    }

    // ---- compiling ----

    [[nodiscard]] CompileDesc any_compile_desc() {
        CompileDesc desc = host_.compile_desc();
        if (one_in(random_, 8)) desc.max_extent = {17, 16};
        if (running_ && one_in(random_, 2)) desc.max_extent = running_->desc.max_extent;
        constexpr std::array formats{float_format, VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_R16G16B16A16_SFLOAT};
        VkFormat format = formats[below(random_, 3)];
        if (running_ && !one_in(random_, 4)) format = running_->desc.target.format;
        desc.target = {format, targets_.at(format).image.info.usage};
        if (kind_ == Kind::Sizes) desc.target_extent = largest;
        desc.kernels = one_in(random_, 4) ? KernelStage::Raster : KernelStage::Compute;
        desc.fuse = one_in(random_, 4);
        desc.views = views_;
        for (const ItemPointer& item : stack_)
            if (item->info == &trail) desc.watches.push_back({.id = item->handle.id, .entry = item->handle});
        for (Watch& watch : desc.watches) watch.target = {float_format, host_.color.image.info.usage};
        return desc;
    }
    [[nodiscard]] Planned planned(const CompileDesc& desc) const {
        Planned out{.desc = desc};
        for (const ItemPointer& item : stack_) {
            const Touch touch = item->info->touch;
            const bool is_merged = touch == Touch::Pointwise || touch == Touch::Warp || !item->is_plain();
            out.entries.push_back({item, item->desc, is_merged});
        }
        return out;
    }
    /// Who compiles it anew must say the same.
    [[nodiscard]] bool can_compile(const Planned& wanted) const {
        Composer anew(host_.device, {.max_threads = 0});
        std::map<std::uint32_t, Handle> handles;
        fill(anew, wanted, handles, {}, black_);
        return anew.compile(desc_for(wanted, handles)).has_value();
    }
    void compile(bool is_now) {
        if (has_thread_ && !is_now && composer_.pending().is_pending) return;
        const CompileDesc desc = any_compile_desc();
        Planned wanted = planned(desc);
        const bool is_possible = can_compile(wanted);
        note(fmt::format("compile{}{}, {}x{}, format {}", is_now ? "" : " later", is_possible ? "" : " (fails)",
                         desc.max_extent.width, desc.max_extent.height, static_cast<int>(desc.target.format)));
        failed_ += is_possible ? 0 : 1;
        if (is_now) {
            const auto made = composer_.compile(desc);
            ASSERT_EQ(made.has_value(), is_possible) << text_ << (made ? "" : "\n" + made.error().text);
            for (auto* const plan : {&ready_, &told_, &coming_}) plan->reset();
            if (made) running_ = std::move(wanted);
            return;
        }
        const auto begun = composer_.compile_later(desc);
        ASSERT_TRUE(begun) << text_ << "\n" << begun.error().text;
        if (has_thread_) {
            if (is_possible) coming_ = std::move(wanted);
            return;
        }
        ASSERT_EQ(!composer_.pending().error.has_value(), is_possible) << text_;
        if (is_possible) ready_ = std::move(wanted);
    }

    /// To the same device: nothing of the old state's is left but what the host gave.
    void rebind() {
        if (!running_ || (has_thread_ && composer_.pending().is_pending)) return;
        const Planned* last = &*running_;
        for (const auto* const plan : {&told_, &ready_, &coming_})
            if (*plan) last = &**plan;
        Planned wanted = planned(last->desc);
        // What trails hold is known of those alone that are watched.
        const auto is_watched = [&](const ItemPointer& item) {
            return item->info != &trail ||
                   std::ranges::find(wanted.desc.watches, item->handle.id, &Watch::id) != wanted.desc.watches.end();
        };
        if (!std::ranges::all_of(stack_, is_watched)) return;
        std::erase_if(wanted.desc.watches, [&](const Watch& watch) {
            return std::ranges::find(stack_, watch.entry, [](const ItemPointer& item) { return item->handle; }) ==
                   stack_.end();
        });
        const bool is_possible = can_compile(wanted);
        note(fmt::format("rebind{}", is_possible ? "" : " (fails)"));
        const auto made = composer_.rebind(host_.device);
        ASSERT_EQ(made.has_value(), is_possible) << text_ << (made ? "" : "\n" + made.error().text);
        if (!made) return;
        for (auto* const plan : {&ready_, &told_, &coming_}) plan->reset();
        running_ = std::move(wanted);
        views_left_.clear();
    }

    // ---- what is expected ----

    [[nodiscard]] static Handed handed_to(Composer& composer, const ReferenceImage& picture) {
        ResourceImage out{picture.width, picture.height, {}};
        for (const Rgba& p : picture.pixels)
            for (const double value : {p.r, p.g, p.b, p.a}) out.rgba.push_back(static_cast<float>(value));
        return {must(composer.define(std::move(out)))};
    }
    /// `trails`: what entries have from the frame before, and `scene`, what it was.
    void fill(Composer& anew, const Planned& plan, std::map<std::uint32_t, Handle>& handles,
              const std::map<const Item*, const ReferenceImage*>& trails, const ReferenceImage& scene) const {
        Handle scene_before;
        const auto reads_before = [](const Planned::Entry& entry) {
            return entry.wires.input.is_previous || entry.wires.source.is_previous || entry.wires.mask.is_previous;
        };
        if (std::ranges::any_of(plan.entries, reads_before)) {
            const Handed given = handed_to(anew, scene);
            scene_before = anew.add(still, &given, {.input = scene_color});
        }
        const auto wire = [&](Handle handle) {
            if (handle.is_previous) return scene_before;
            if (!handle.is_given() || handle == scene_color || handle == scene_alpha) return handle;
            const auto found = handles.find(handle.id);
            return found == handles.end() ? Handle{~0U - 7} : found->second;
        };
        for (const Planned::Entry& entry : plan.entries) {
            const Item& item = *entry.item;
            EntryDesc desc = entry.wires;
            desc.name.clear();
            desc.enabled = item.desc.enabled;
            desc.opacity = item.desc.opacity;
            desc.blend = item.desc.blend;
            // What is planned without a mix shows none until it is compiled again.
            if (!entry.is_mixable) {
                desc.blend = BlendMode::Mix;
                if (desc.opacity > 0) desc.opacity = 1;
            }
            // Before the first entry there may be one that is not in the stack.
            if (&entry == plan.entries.data() && !desc.input.is_given()) desc.input = scene_color;
            desc.input = wire(desc.input);
            desc.source = wire(desc.source);
            desc.mask = wire(desc.mask);
            const EffectInfo* info = item.info;
            const void* words = item.words.data();
            Handed before_it;
            if (info == &trail) {
                info = &handed;
                const auto found = trails.find(&item);
                const ReferenceImage& before = found == trails.end() ? black_ : *found->second;
                before_it = handed_to(anew, before);
                words = &before_it;
            }
            const Handle handle = anew.add(*info, words, desc);
            handles[item.handle.id] = handle;
            for (LayerDesc layer : item.layers) {
                layer.values[0].entry = handle;
                must(anew.add_layer(layer));
            }
            for (const Item::Pulse& pulse : item.pulses) {
                PulseDesc own = pulse.desc;
                own.entry = handle;
                own.event = fmt::format("{} {}", handle.id, &pulse - item.pulses.data());
                must(anew.add_pulse(own));
                if (pulse.start) static_cast<void>(anew.fire(own.event, *pulse.start));
            }
            for (const Item::Override& one : item.overrides)
                must(anew.set_override(handle, one.row, one.owner, one.words));
        }
    }
    [[nodiscard]] static CompileDesc desc_for(const Planned& plan, const std::map<std::uint32_t, Handle>& handles) {
        CompileDesc desc = plan.desc;
        for (Watch& watch : desc.watches) watch.entry = handles.at(watch.entry.id);
        return desc;
    }
    [[nodiscard]] static bool fits(const Planned& plan, const Frame& frame) {
        const VkExtent2D extent = frame.color.region.extent;
        return extent.width <= plan.desc.max_extent.width && extent.height <= plan.desc.max_extent.height &&
               frame.target.format == plan.desc.target.format && frame.view < plan.desc.views;
    }

    // ---- frames ----

    [[nodiscard]] Frame any_frame() {
        // Of what runs, or of what is to run next.
        const bool is_ready = composer_.pending().is_ready;
        const auto& next = asked_ ? told_ : has_thread_ ? coming_ : ready_;
        const Planned& shown = is_ready && next && one_in(random_, 2) ? *next : *running_;
        Frame frame = host_.frame();
        VkExtent2D extent = shown.desc.max_extent;
        if (kind_ == Kind::Sizes && one_in(random_, 3)) extent = {9 + below(random_, 9), 8};
        is_other_ = kind_ == Kind::Trails && one_in(random_, 2);
        if (is_other_) frame.color = test::image_ref(other_);
        frame.color.region = {{}, extent};
        frame.view = below(random_, views_);
        frame.target = test::image_ref(targets_.at(shown.desc.target.format), {{}, extent});
        if (kind_ == Kind::Sizes && one_in(random_, 3)) frame.target.region.extent = {13, 11};
        if (!one_in(random_, 8)) time_ += 1.0 / 60;
        frame.time = time_;
        frame.frame_index = ++number_;
        frame.camera.view[12] = static_cast<float>(below(random_, 12));
        frame.camera.is_cut = one_in(random_, 20) || extent.width != left_of(frame.view).extent.width ||
                              extent.height != left_of(frame.view).extent.height;
        frame.delta_time = one_in(random_, 32) ? -1 : 1.0 / 60;
        return frame;
    }
    void give_watched(Frame& frame, const Planned& plan, std::vector<Watched>& watched,
                      std::map<std::uint32_t, gpu::test::Picture>& pictures, const VkExtent2D& extent) const {
        for (const Watch& watch : plan.desc.watches) {
            auto found = pictures.find(watch.id);
            if (found == pictures.end())
                found =
                    pictures.emplace(watch.id, gpu::test::blank(host_.device.context(), largest, float_format)).first;
            watched.push_back({.id = watch.id, .target = test::image_ref(found->second, {{}, extent})});
        }
        frame.watched = watched;
    }
    [[nodiscard]] ReferenceImage shown(const gpu::test::Picture& picture, VkExtent2D extent) const {
        const ReferenceImage whole = test::image_of(gpu::test::download(host_.device.context(), picture));
        ReferenceImage out(extent.width, extent.height);
        for (std::uint32_t y = 0; y < extent.height; ++y)
            for (std::uint32_t x = 0; x < extent.width; ++x) out.at(x, y) = whole.at(x, y);
        return out;
    }
    /// Which plan shows the frame.
    void take(const Frame& frame) {
        if (has_thread_) {
            if (coming_ && !composer_.pending().is_pending) running_ = std::exchange(coming_, std::nullopt);
            return;
        }
        auto& next = asked_ ? told_ : ready_;
        if (next && (fits(*next, frame) || !fits(*running_, frame))) running_ = std::exchange(next, std::nullopt);
    }
    void frame() {
        Frame frame = any_frame();
        const VkExtent2D extent = frame.color.region.extent;
        std::vector<Watched> watched;
        Planned all = *running_;
        for (const auto* const other : {&ready_, &told_, &coming_})
            if (*other)
                for (const Watch& watch : (*other)->desc.watches)
                    if (std::ranges::find(all.desc.watches, watch.id, &Watch::id) == all.desc.watches.end())
                        all.desc.watches.push_back(watch);
        give_watched(frame, all, watched, watched_, extent);
        const bool is_taken_back = one_in(random_, 8);
        for (const ItemPointer& item : stack_)
            for (Item::Pulse& pulse : item->pulses)
                if (std::exchange(pulse.is_waiting, false)) pulse.start = frame.time;
        note(fmt::format("frame {} of {}x{}, view {}{}{}", frame.frame_index, extent.width, extent.height, frame.view,
                         frame.camera.is_cut || frame.delta_time < 0 ? ", a cut" : "",
                         is_taken_back ? ", once in vain" : ""));
        if (is_taken_back) {
            test::record_in_vain(composer_, host_, frame);
            must(composer_.abandon());
        }
        const auto recorded = host_.record(composer_, frame);
        ASSERT_TRUE(recorded) << text_ << "\n" << recorded.error().text;
        take(frame);
        if (one_in(random_, 6)) composer_.wait_for_kernels();
        expect(frame);
    }
    [[nodiscard]] LeftOfView& left_of(std::uint32_t view) { return views_left_[view]; }
    [[nodiscard]] bool goes_on(const Left& left, const LeftOfView& view, bool is_cut) const {
        return !is_cut && left.recording > 0 && left.recording + 1 == view.recordings &&
               left.max_extent.width == running_->desc.max_extent.width;
    }
    /// Compiles what runs now anew, with what its trails must have.
    void expect(Frame frame) {
        const VkExtent2D extent = frame.color.region.extent;
        LeftOfView& view = left_of(frame.view);
        view.extent = extent;
        ++view.recordings;
        const bool is_cut = frame.camera.is_cut || frame.delta_time < 0;
        std::map<const Item*, const ReferenceImage*> trails;
        for (const Planned::Entry& entry : running_->entries) {
            const auto left = view.trails.find(entry.item);
            if (left == view.trails.end() || !goes_on(left->second, view, is_cut)) continue;
            trails[entry.item.get()] = &left->second.picture;
            ++went_on_;
        }
        Composer anew(host_.device, {.max_threads = 0});
        std::map<std::uint32_t, Handle> handles;
        black_ = ReferenceImage(extent.width, extent.height);
        for (Rgba& pixel : black_.pixels) pixel = {0, 0, 0, 0};
        const bool has_scene = goes_on(view.scene, view, is_cut);
        fill(anew, *running_, handles, trails, has_scene ? view.scene.picture : black_);
        const auto made = anew.compile(desc_for(*running_, handles));
        ASSERT_TRUE(made) << text_ << "\n" << made.error().text;
        std::vector<Watched> watched;
        give_watched(frame, *running_, watched, expected_watched_, extent);
        const VkRect2D region = frame.target.region;
        frame.target = test::image_ref(expected_.at(running_->desc.target.format), region);
        must(host_.record(anew, frame));
        const ReferenceImage expected = shown(expected_.at(running_->desc.target.format), region.extent);
        const ReferenceImage out = shown(targets_.at(running_->desc.target.format), region.extent);
        ASSERT_LE(difference(out, expected),
                  std::max(step_of(running_->desc.target.format), gpu::test::code_between_kernels()))
            << text_;
        for (const Planned::Entry& entry : running_->entries) {
            if (entry.item->info != &trail) continue;
            const std::uint32_t id = entry.item->handle.id;
            const WatchState state = composer_.watch_state(id);
            ASSERT_EQ(state, anew.watch_state(id)) << text_ << "\n" << entry.item->desc.name;
            if (state != WatchState::Shown && state != WatchState::InputShown) continue;
            const ReferenceImage of_trail = shown(watched_.at(id), extent);
            const ReferenceImage expected_trail = shown(expected_watched_.at(id), extent);
            ASSERT_LE(difference(of_trail, expected_trail),
                      std::max(step_of(float_format), gpu::test::code_between_kernels()))
                << text_ << "\n"
                << entry.item->desc.name;
            if (state == WatchState::Shown)
                view.trails[entry.item] = {of_trail, running_->desc.max_extent, view.recordings};
        }
        // It is kept where somebody reads it who is on.
        const Plan& plan = *composer_.current_plan();
        const auto is_kept = [&](const PlanPass& pass) {
            return pass.writes.image < plan.images.size() && plan.images[pass.writes.image].name == "scene.output";
        };
        if (std::ranges::any_of(plan.passes, is_kept)) {
            scenes_went_on_ += has_scene ? 1 : 0;
            view.scene = {shown(is_other_ ? other_ : host_.color, extent), running_->desc.max_extent, view.recordings};
        }
    }

    std::mt19937 random_;
    Kind kind_;
    test::Host host_;
    gpu::test::Picture other_;
    std::uint32_t views_;
    bool has_thread_, asks_first_, asked_ = false, is_other_ = false;
    Composer composer_;
    std::string text_;  ///< all that was done
    std::map<VkFormat, gpu::test::Picture> targets_, expected_;
    std::map<std::uint32_t, gpu::test::Picture> watched_, expected_watched_;
    ReferenceImage black_{1, 1};
    std::vector<ItemPointer> stack_, replaced_;
    std::optional<Planned> running_, ready_, told_, coming_;
    std::map<std::uint32_t, LeftOfView> views_left_;
    std::unique_ptr<CustomEffect> fresh_;
    std::vector<std::unique_ptr<CustomEffect>> kept_;
    std::uint64_t number_ = 0, names_ = 0, went_on_ = 0, scenes_went_on_ = 0, failed_ = 0;
    double time_ = 0;
};

class ComposeDifferential : public test::StackTest {};
class SoakDifferential : public test::StackTest {};

void expect_equal_pictures(std::uint32_t first, std::uint32_t seeds, int steps) {
    DirtyDevice dirty;
    std::uint64_t went_on = 0, scenes = 0, failed = 0;
    for (std::uint32_t seed = first; seed < first + seeds; ++seed) {
        Run run(dirty.device(), seed);
        for (int i = 0; i < steps && !::testing::Test::HasFailure(); ++i) run.step();
        if (::testing::Test::HasFailure()) return;
        went_on += run.trails_that_went_on();
        scenes += run.scenes_that_went_on();
        failed += run.failed_compiles();
    }
    // How many there are goes by how fast kernels are made; of a few seeds it may be none.
    if (test::is_small()) return;
    EXPECT_GT(went_on, 0U) << "no history went on";
    EXPECT_GT(scenes, 0U) << "no scene of a frame before was read";
    EXPECT_GT(failed, 0U) << "no compile failed";
}

TEST_F(ComposeDifferential, WhatIsEditedShowsWhatIsCompiledAnew) {
    expect_equal_pictures(0, test::is_small() ? 4 : 16, 20);
}

TEST_F(SoakDifferential, WhatIsEditedShowsWhatIsCompiledAnew) { expect_equal_pictures(1000, 500, 40); }

}  // namespace
}  // namespace darkroom::differential
