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
// thread. A Composer is used by one thread at a time; its recordings go to one queue, in order. Up to frames_in_flight
// * views recordings may be unfinished; a further record may be made only when the oldest of them has finished.
// compile() keeps what unfinished recordings use; a Composer is destroyed only when all its recordings have finished.
//
// The command buffer is a primary one or not, of a queue with graphics and compute, and outside of rendering. `record`
// leaves other pipelines and descriptor sets bound at both bind points, and another viewport and scissor; push
// constants, vertex and index buffers are as they were. Before it records, it checks each image that the plan uses.

#include <cstdint>
#include <darkroom/blend_mode.hpp>
#include <darkroom/device.hpp>
#include <darkroom/effect.hpp>
#include <darkroom/frame.hpp>
#include <darkroom/plan.hpp>
#include <darkroom/result.hpp>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace darkroom {

/// The output of one entry of a stack. A default one is "the output of the pass before".
struct Handle {
    std::uint32_t id = 0;
    [[nodiscard]] bool is_given() const { return id != 0; }
    friend bool operator==(Handle, Handle) = default;
};
/// The scene colour as the host gives it: an input for any entry.
inline constexpr Handle scene_color{~0u};

/// What belongs to the stack entry, not to the effect.
struct EntryDesc {
    Handle input;        ///< the picture; default: the entry before
    Handle source;       ///< what effects with passes read instead of the picture (bloom: the scene)
    Handle second;       ///< the second picture of effects that take two
    Handle mask;         ///< luminance of this picture scales opacity, pixel by pixel
    std::string name;    ///< of the entry; default: the effect's name, then name#2 ...
    std::string output;  ///< a name for its output, for looks
    bool enabled = true;
    float opacity = 1.0f;  ///< [0, 1]
    BlendMode blend =
        BlendMode::Mix;  ///< how the result goes over the input: the input is the base, the result the layer
};

struct ComposerDesc {
    std::uint32_t frames_in_flight = 2;
    bool has_timers = false;  ///< GPU timestamps around every pass
};

/// What every frame's image of one kind is, as the host made it: its view's format and the usage of the image.
struct ImageUse {
    VkFormat format = VK_FORMAT_UNDEFINED;  ///< UNDEFINED: not given
    /// Inputs need SAMPLED; with STORAGE own pixels are read cheaper. A target needs COLOR_ATTACHMENT or STORAGE.
    VkImageUsageFlags usage = VK_IMAGE_USAGE_SAMPLED_BIT;
    friend bool operator==(const ImageUse&, const ImageUse&) = default;
};

/// What the frames will be like. Compile again when one of these changes.
struct CompileDesc {
    VkExtent2D max_extent{};
    ImageUse color{VK_FORMAT_R16G16B16A16_SFLOAT};
    ImageUse depth;
    /// Every frame's camera says DepthKind::Planar: the depth image is then read as it is, without a pass.
    bool is_depth_planar = false;
    ImageUse normals;
    ImageUse velocity;
    /// Every frame's camera says the default VelocityKind: velocity is then read as it is, without a pass.
    bool is_velocity_plain = false;
    ImageUse ui;
    bool has_shadows = false;  ///< frames have lights with cascades in D32_SFLOAT
    ImageUse target{VK_FORMAT_R8G8B8A8_UNORM, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT};
    /// (0, 0): the target is as large as the picture at the end of the stack. Else the largest extent of a target with
    /// an extent of its own, into which the last kernel samples the picture, bilinearly.
    VkExtent2D target_extent{};
    /// What the target takes: Encoded for pictures that are shown, SceneLinear for float files (encode and dither are
    /// then skipped). Unset: Encoded for UNORM and SRGB formats, SceneLinear for float formats.
    std::optional<Domain> target_domain;
    /// Whether a picture that the stack leaves unencoded is sRGB-encoded for an Encoded target. Unset: for UNORM
    /// formats; an SRGB one does it itself, and who chooses Encoded for floats encodes in the stack.
    std::optional<bool> encodes_target;
    std::uint32_t views = 1;
    KernelStage kernels = KernelStage::Auto;
    bool fuse = true;  ///< false: every effect a pass of its own (tests, benchmarks)
    VkFormat intermediate = VK_FORMAT_R16G16B16A16_SFLOAT;  ///< of pictures between kernels
};

/// Per-pass times of one finished recording.
struct PassTime {
    std::string_view name;
    double milliseconds = 0;
};

class Composer {
  public:
    explicit Composer(Device& device, const ComposerDesc& desc = {});
    Composer(Composer&&) noexcept;
    Composer& operator=(Composer&&) noexcept;
    ~Composer();

    /// Appends an effect; no input named means the output of the pass before.
    template <class Effect>
    Handle add(const Effect& parameters, const EntryDesc& desc = {}) {
        return add(effect_info(parameters), &parameters, desc);
    }
    /// The same for an effect known at run time. `parameters`: info.parameters.words() words, or null for defaults.
    Handle add(const EffectInfo& info, const void* parameters, const EntryDesc& desc = {});
    void clear();

    // Entries: found by name, changed between frames. Errors name the entry, the value and what is allowed.
    [[nodiscard]] std::optional<Handle> find(std::string_view entry_name) const;
    [[nodiscard]] std::size_t size() const;
    [[nodiscard]] Handle entry(std::size_t index) const;
    [[nodiscard]] const EffectInfo& info(Handle) const;
    [[nodiscard]] const EntryDesc& desc(Handle) const;
    [[nodiscard]] std::span<const std::uint32_t> words(Handle) const;
    Result<> set_enabled(Handle, bool enabled);
    Result<> set_opacity(Handle, float opacity);
    /// Sets a base value from `words` of the row's kind; out of range is refused with the interval.
    Result<> set(Handle, std::string_view parameter, std::span<const std::uint32_t> words);
    Result<> set(Handle, std::string_view parameter, double value);
    template <class Effect>
    Result<> set(Handle handle, const Effect& parameters) {
        return set_all(handle, effect_info(parameters), &parameters);
    }
    /// A per-frame override by `owner` (a pulse, a script slot, a layer): replaces the base value until dropped; the
    /// last owner to set wins. The base value is never touched.
    Result<> set_override(Handle, std::string_view parameter, std::string_view owner,
                          std::span<const std::uint32_t> words);
    void drop_overrides(std::string_view owner);
    /// The values that the next record uses.
    [[nodiscard]] std::vector<std::uint32_t> current(Handle) const;

    /// Plans the stack, compiles its kernels, allocates what it needs. The previous plan stays alive until the
    /// recordings made with it have finished.
    [[nodiscard]] Result<Plan> compile(const CompileDesc& desc);
    /// The same without a device's objects: for `darkroom plan`.
    [[nodiscard]] Result<Plan> plan(const CompileDesc& desc) const;

    /// Records the whole stack. Errors (a missing or mismatching image, an extent beyond the compiled maximum, no plan)
    /// record nothing; they name the image and the field, such as frame.depth.layout.
    Result<> record(VkCommandBuffer commands, const Frame& frame);

    /// Waits for kernels that are being built for the present toggles. For headless work and tests, not for frame
    /// loops.
    void wait_for_kernels();
    /// Times of the last recording that has finished, in order; empty without timers. Never waits.
    [[nodiscard]] std::span<const PassTime> times();
    /// CPU time of the last record, in microseconds.
    [[nodiscard]] double record_microseconds() const;
    /// After device loss: keeps the stack, compiles it on another device with the last CompileDesc.
    [[nodiscard]] Result<Plan> rebind(Device& device);

  private:
    Result<> set_all(Handle, const EffectInfo&, const void* parameters);
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace darkroom
