// SPDX-License-Identifier: MIT
#pragma once
// The Composer: an ordered stack of effects that turns a host's HDR frame into a finished picture inside the host's own
// command buffer.
//
//     darkroom::Composer composer(device, {.frames_in_flight = 2});
//     composer.add(darkroom::Bloom{.intensity = 0.08f});
//     composer.add(darkroom::Tonemap{});
//     composer.add(darkroom::Encode{});
//     auto plan = composer.compile({.max_extent = {1920, 1080}, .depth = {VK_FORMAT_D32_SFLOAT}});
//     composer.record(command_buffer, {.color = hdr, .time = seconds, .target = target});   // every frame
//
// The contract. `add`, `compile`, `set` and the like may allocate and take time. `record` allocates nothing, throws
// nothing, waits for nothing, submits nothing, and owns nothing the host made; each host image is left in the layout
// its reference asks for. A toggle or a parameter is seen by the next record and compiles nothing on the calling
// thread. The stack may be edited while the picture runs: compile_later() plans it anew on the Composer's thread.
// A Composer is used by one thread at a time; its recordings go to one queue, in order. Up to frames_in_flight
// * views recordings may be unfinished; a further record may be made only when the oldest of them has finished.
// A Composer is destroyed only when all its recordings have finished.
//
// The command buffer is a primary one or not, of the device's queue family, and outside of rendering. `record` leaves
// other pipelines and descriptor sets bound at both bind points, and all dynamic state to be set anew; push constants,
// vertex and index buffers are as they were. Before it records, it checks each image that the plan uses.

#include <array>
#include <cstdint>
#include <darkroom/blend_mode.hpp>
#include <darkroom/device.hpp>
#include <darkroom/frame.hpp>
#include <darkroom/handle.hpp>
#include <darkroom/kernel_statistics.hpp>
#include <darkroom/modulation.hpp>
#include <darkroom/plan.hpp>
#include <darkroom/recording.hpp>
#include <darkroom/resource.hpp>
#include <darkroom/result.hpp>
#include <darkroom/watch.hpp>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace darkroom {

struct EffectInfo;

inline constexpr std::uint32_t previous_pre_roll = 60;

/// What belongs to the stack entry, not to the effect.
struct EntryDesc {
    Handle input;   ///< the picture; default: the entry before
    Handle source;  ///< what effects with passes read instead of the picture (bloom: the scene)
    Handle second;  ///< the second picture of effects that take two; by default that of effects that need ui is
                    ///< what the interface's chain has made so far
    Handle mask;    ///< luminance of this picture scales opacity, pixel by pixel
    /// Of the interface's own chain: its default input is the entry before it in that chain, or the interface's image.
    /// Entries of the picture's chain skip it. Composer::ui() adds such entries.
    bool is_ui = false;
    std::string name;    ///< of the entry; default: the effect's name, then name#2 ...
    std::string output;  ///< a name for its output, for looks
    bool enabled = true;
    float opacity = 1.0f;  ///< [0, 1]
    BlendMode blend =
        BlendMode::Mix;  ///< how the result goes over the input: the input is the base, the result the layer
    /// Size that the entry works at, and its output has, relative to its input, which is then read by one bilinear tap
    /// a pixel: a quarter of each side is best made in two steps.
    OutputScale scale;
    /// Of the image that holds its output. UNDEFINED: CompileDesc::intermediate, where it becomes an image at all.
    VkFormat format = VK_FORMAT_UNDEFINED;
};

struct ComposerDesc {
    std::uint32_t frames_in_flight = 2;
    bool has_timers = false;  ///< GPU timestamps around every pass
    /// Threads that the library may run beside the caller's: one of the Composer's own, and while it compiles as many
    /// more as there are processors. 0: none; compile_later() then compiles before it returns, and kernels for changed
    /// toggles and choices are built by wait_for_kernels() alone.
    std::uint32_t max_threads = ~0u;
};

/// What the frames will be like. Compile again when one of these changes.
struct CompileDesc {
    VkExtent2D max_extent{};
    ImageUse color{VK_FORMAT_R16G16B16A16_SFLOAT};
    bool is_color_associated = false;  ///< the frames' colour is multiplied by its alpha: ColorState::is_associated
    ImageUse depth;
    /// Every frame's camera says DepthKind::Planar: the depth image is then read as it is, without a pass.
    bool is_depth_planar = false;
    ImageUse normals;
    ImageUse velocity;
    /// Every frame's camera says the default VelocityKind: velocity is then read as it is, without a pass.
    bool is_velocity_plain = false;
    ImageUse ui;
    ImageUse reactive;
    ImageUse transparency;
    ImageUse exposure;
    bool has_shadows = false;  ///< frames have lights with cascades in D32_SFLOAT
    ImageUse target{VK_FORMAT_R8G8B8A8_UNORM, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT};
    /// (0, 0): the target is as large as the picture at the end of the stack. Else the largest extent of a target with
    /// an extent of its own, into which the last kernel samples the picture, bilinearly.
    VkExtent2D target_extent{};
    /// What the target (of an SRGB format, its image) takes: the last kernel makes it of a picture in any other state.
    std::optional<ColorState> target_color;
    /// Encoded for pictures that are shown, SceneLinear for float files (encode and dither are then skipped). Unset:
    /// Encoded for UNORM and SRGB formats, SceneLinear for float formats.
    std::optional<Domain> target_domain;
    /// Whether light that the stack leaves is then sRGB-encoded for an Encoded target. Unset: for UNORM formats.
    std::optional<bool> encodes_target;
    std::uint32_t views = 1;
    KernelStage kernels = KernelStage::Auto;
    bool fuse = true;  ///< false: every effect a pass of its own (tests, benchmarks)
    VkFormat intermediate = VK_FORMAT_R16G16B16A16_SFLOAT;  ///< of pictures between kernels
    std::vector<Watch> watches;                             ///< what frames may look at; see darkroom/watch.hpp
};

class UiChain;

class Composer {
  public:
    /// Shares what it needs of the device: the Device object may go first.
    explicit Composer(const Device& device, const ComposerDesc& desc = {});
    Composer(Composer&&) noexcept;
    Composer& operator=(Composer&&) noexcept;
    ~Composer();

    /// For effects that gather earlier frames: where within the pixel a frame is drawn. Camera::jitter, in pixels of
    /// Frame::color, y down: a Halton sequence (bases 2 and 3) about 0 with 8 * scale^2 entries. `scale`: lines of the
    /// output to those of the frame, 1 and more. jittered() moves a projection by it.
    [[nodiscard]] static std::array<float, 2> jitter(std::uint64_t frame_index, float scale = 1);
    /// What to add to the mip bias of all samplers of the scene, so that the gathered picture is as sharp as a frame of
    /// the output's size: -log2(scale).
    [[nodiscard]] static float mip_bias(float scale);

    // The stack. Edits keep the values, overrides and histories of the entries that stay; record() goes on with the
    // plan it has, and the present values of that plan's entries, until a compile has made another.
    /// Appends an effect; no input named means the output of the entry before.
    template <class Effect>
    Handle add(const Effect& parameters, const EntryDesc& desc = {}) {
        return add(effect_info(parameters), &parameters, desc);
    }
    /// The same for an effect known at run time. `parameters`: info.parameters.words() words, or null for defaults.
    Handle add(const EffectInfo& info, const void* parameters, const EntryDesc& desc = {});
    /// Puts an effect in front of an entry.
    template <class Effect>
    Result<Handle> insert(Handle before, const Effect& parameters, const EntryDesc& desc = {}) {
        return insert(before, effect_info(parameters), &parameters, desc);
    }
    Result<Handle> insert(Handle before, const EffectInfo& info, const void* parameters, const EntryDesc& desc = {});
    /// The interface's own stack, over the image Frame::ui, which is as large as the target. What needs a UI image
    /// (UiComposite) joins the two; the picture's effects never see the interface, nor its effects the picture.
    [[nodiscard]] UiChain ui();
    /// Takes an entry out. Entries that name it as an input must be removed, or wired anew, before the next compile.
    Result<> remove(Handle handle);
    /// Puts an entry in front of another; a default `before`: behind the last.
    Result<> move(Handle handle, Handle before);
    /// Another effect in an entry's place, with its handle, name and wiring. Values and overrides are those of the new
    /// effect: none are kept, unless it is the same effect.
    template <class Effect>
    Result<> replace(Handle handle, const Effect& parameters) {
        return replace(handle, effect_info(parameters), &parameters);
    }
    Result<> replace(Handle handle, const EffectInfo& info, const void* parameters);
    /// Wires an entry anew: its inputs, mask, opacity (also one that set_opacity() refuses) and blend mode are those of
    /// `desc`, and its output's name; an empty name keeps the entry's. Needs a compile; the plan that runs until then
    /// keeps its wires and goes on with the entry's values.
    Result<> rewire(Handle handle, const EntryDesc& desc);
    void clear();

    // Tables and pictures that entries read. A stack is compiled with those that are defined then.
    /// For parameters of kind Resource. No number is given twice. Errors: a table or picture whose data does not fit
    /// its size.
    Result<Resource> define(ResourceData data);
    /// Frees it with the last plan that was compiled with it.
    void forget(Resource resource);
    [[nodiscard]] const Resources& resources() const;
    /// A picture that was defined, as an input for any entry.
    [[nodiscard]] static Handle picture_of(Resource resource) { return {resource.id}; }

    // Entries: found by name, changed between frames. Errors name the entry, the value and what is allowed; a handle
    // that names no entry is one of them.
    [[nodiscard]] std::optional<Handle> find(std::string_view entry_name) const;
    [[nodiscard]] std::size_t size() const;
    [[nodiscard]] Handle entry(std::size_t index) const;
    /// Why a handle names no entry of this stack.
    [[nodiscard]] Result<> check(Handle) const;
    /// Null: the handle names no entry.
    [[nodiscard]] const EffectInfo* info(Handle) const;
    [[nodiscard]] const EntryDesc* desc(Handle) const;
    /// Base values; empty: the handle names no entry.
    [[nodiscard]] std::span<const std::uint32_t> words(Handle) const;
    Result<> set_enabled(Handle, bool enabled);
    Result<> set_opacity(Handle, float opacity);
    /// Sets a base value from `words` of the row's kind; out of range is refused with the interval.
    Result<> set(Handle, std::string_view parameter, std::span<const std::uint32_t> words);
    Result<> set(Handle, std::string_view parameter, double value);
    template <class Effect>
    Result<> set(Handle handle, const Effect& parameters) {
        return set(handle, effect_info(parameters), &parameters);
    }
    /// All values of an entry of this effect, info.parameters.words() words.
    Result<> set(Handle, const EffectInfo& info, const void* parameters);
    /// Finds a parameter once, for set() in every frame, which then compares no names.
    [[nodiscard]] Result<ParameterId> parameter(Handle, std::string_view name) const;
    /// As set() by name. Errors: its entry was removed, or has another effect.
    Result<> set(ParameterId parameter, std::span<const std::uint32_t> words);
    /// A per-frame override by `owner` (a script slot, a timeline): replaces the value, and what layers and pulses make
    /// of it, until dropped; the last owner to set wins. The base value is never touched.
    Result<> set_override(Handle, std::string_view parameter, std::string_view owner,
                          std::span<const std::uint32_t> words);
    void drop_overrides(std::string_view owner);
    /// The values at the time and from the camera of the last record; empty: the handle names no entry.
    [[nodiscard]] std::vector<std::uint32_t> current(Handle) const;
    /// The same at any time and from any camera, and what layers make of the entry's `enabled` and `opacity`. An
    /// opacity between 0 and 1 that the plan there is cannot show is 1 until the stack is compiled again.
    struct EntryValues {
        std::vector<std::uint32_t> words;
        bool is_enabled = true;
        float opacity = 1;
    };
    [[nodiscard]] EntryValues values_at(Handle, double time, const Camera& camera) const;
    /// How many frames to develop before the first that is wanted, so that a run which begins in the middle gives the
    /// picture of an unbroken one: the sum of EffectInfo::pre_roll over the entries that are on, with their current
    /// values, because a history that is made from a picture with a history settles after it; and previous_pre_roll for
    /// every picture that is read as the frame before, of which nobody knows when it settles. `delta_time`: as Frame
    /// has it; below 0 every frame resets the histories, so 0. Needs no compile.
    [[nodiscard]] std::uint32_t pre_roll(double delta_time = 0) const;

    // Layers and pulses (darkroom/modulation.hpp). Each lasts until its entry is removed, or another effect is there.
    /// Errors: an entry or parameter that is not there, one that is not made of numbers, a duration that is not above
    /// 0.
    Result<> add_pulse(const PulseDesc& desc);
    /// Starts all pulses of this event anew at `time`, as Frame::time has it; by default with the next record. Returns
    /// how many there are. Allocates nothing.
    std::size_t fire(std::string_view event, std::optional<double> time = std::nullopt);
    /// Errors: a name that another layer has, no values, one that is out of range, a distance that is none. One that
    /// moves an opacity which set_opacity() would refuse shows it with the next compile; a message of the log says so.
    Result<> add_layer(const LayerDesc& desc);
    /// Of a layer: from 0, where it changes nothing, to 1, where its values replace the base. Refused outside of that.
    Result<> set_layer_weight(std::string_view name, float weight);
    [[nodiscard]] std::vector<std::string> layer_names() const;
    void remove_pulses();
    void remove_layer(std::string_view name);

    /// Plans the stack, makes the kernels that the device does not have yet, allocates what it needs. The previous plan
    /// stays alive until the recordings made with it have finished. Waits for a compile_later() that has begun.
    [[nodiscard]] Result<Plan> compile(const CompileDesc& desc);
    /// The same on the Composer's own thread, from the stack as it is now. Returns at once; the first record() behind
    /// it whose frame has the formats and extents of `desc` takes the new plan, and until then frames of the old ones
    /// go on. A newer call replaces one that is not taken.
    Result<> compile_later(const CompileDesc& desc);
    [[nodiscard]] PendingCompile pending() const;
    /// The plan that the next record() takes; null: none is ready. For a host that places barriers by what plans tell:
    /// from the first call on, record() takes no plan that the last call has not told of. Valid until the Composer
    /// records or compiles again.
    [[nodiscard]] const Plan* coming_plan();
    /// What record() works by; null: nothing yet. Valid until the Composer records or compiles again.
    [[nodiscard]] const Plan* current_plan() const;
    /// The same as compile() without a device's objects, so on Device::assumed(), too: for `darkroom plan`.
    [[nodiscard]] Result<Plan> plan(const CompileDesc& desc) const;
    /// What the driver's compiler makes of the kernels of that plan, one for each of its passes: lean ones, as frames
    /// get them with the present values. Needs a device of DeviceDesc::compiles_only.
    [[nodiscard]] Result<std::vector<KernelStatistics>> statistics(const CompileDesc& desc) const;

    /// Records the whole stack. Errors (a missing or mismatching image, an extent beyond the compiled maximum, no plan)
    /// record nothing; they name the image and the field, such as frame.depth.layout.
    Result<> record(VkCommandBuffer commands, const Frame& frame);
    /// The last recording will not be submitted: what it did to histories, uploads and the ring of frames is taken
    /// back. An error: there is none, or it was taken back.
    Result<> abandon();

    /// Of the last record.
    [[nodiscard]] WatchState watch_state(std::uint32_t id) const;
    /// Waits for kernels that are being built for the present toggles. For headless work and tests, not for frame
    /// loops.
    void wait_for_kernels();
    /// Times of the last recording that has finished; no passes without timers. Never waits.
    [[nodiscard]] RecordingTimes times();
    /// A value that effects of the plan make (PassBuilder::value), as the newest recording of the view left it of which
    /// frames_in_flight says that it has finished. Never waits.
    [[nodiscard]] ValueReading value(std::string_view name, std::uint32_t view = 0) const;
    /// CPU time of the last record, in microseconds.
    [[nodiscard]] double record_microseconds() const;
    /// After device loss: keeps the stack, compiles it on another device with the last CompileDesc.
    [[nodiscard]] Result<Plan> rebind(const Device& device);

  private:
    friend class KernelFile;
    struct State;
    std::unique_ptr<State> state_;
};

/// What Composer::ui() gives: entries appended here are those of the interface.
class UiChain {
  public:
    explicit UiChain(Composer& composer) : composer_(&composer) {}
    template <class Effect>
    Handle add(const Effect& parameters, EntryDesc desc = {}) {
        desc.is_ui = true;
        return composer_->add(parameters, desc);
    }
    Handle add(const EffectInfo& info, const void* parameters, EntryDesc desc = {}) {
        desc.is_ui = true;
        return composer_->add(info, parameters, desc);
    }

  private:
    Composer* composer_;
};

inline UiChain Composer::ui() { return UiChain(*this); }

}  // namespace darkroom
