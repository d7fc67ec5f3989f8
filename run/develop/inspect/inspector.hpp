// SPDX-License-Identifier: MIT
#pragma once
// Pixel forensics: what every entry of a stack makes of a pixel. A Composer of its own holds the same stack, every
// entry a pass by itself with pictures of 32-bit floats, and looks at each output; the stack that is inspected, its
// plan and its picture stay as they are. Values are hence those before any rounding of images between kernels.
//
//     Inspector inspector(device, {.max_pixels = 1});
//     inspector.update(composer, compile_desc, frame);      // every frame: does nothing unless the stack was edited
//     inspector.record(commands, composer, frame, pixels);  // behind composer.record()
//     inspector.result(number);                             // once that submission has finished
//
// Histories of the second Composer begin when it does, and anew when the stack is edited: a trail is as long as it was
// watched. It records and compiles as any Composer does: record() waits for nothing, and until a compile has ended
// there is no result.

#include <darkroom/composer.hpp>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "develop/developer.hpp"

namespace darkroom {

struct InspectorDesc {
    std::uint32_t frames_in_flight = 2;
    std::uint32_t max_pixels = 1;
    ImageUse view{VK_FORMAT_UNDEFINED};  ///< of the targets of views; UNDEFINED: there are none
};

using PixelValue = std::array<float, 4>;
[[nodiscard]] bool is_finite(const PixelValue& value);

enum class EntryPresence : std::uint8_t { On, Off, LeftOut };

/// One entry, and what it made of the pixel; of one that is not on, its input goes through.
struct InspectedEntry {
    Handle entry;
    std::string name;
    std::string effect;
    EntryPresence presence = EntryPresence::On;
    std::string why;  ///< where it is not on
    bool is_ui = false;
    bool has_neighbours = false;          ///< reads more of the picture than this pixel
    Domain domain = Domain::SceneLinear;  ///< of its output
    std::optional<PixelValue> before;     ///< not: its input is neither the scene nor an entry of this frame
    PixelValue after{};
    std::string input;  ///< the entry that `before` is of; "scene"
    /// Largest difference of a channel, in the picture's own units, and that in terms of the channel before; infinite
    /// where one of the values is not finite.
    double change = 0, relative_change = 0;
};

struct InspectedPixel {
    VkOffset2D at{};
    PixelValue scene{};
    std::vector<InspectedEntry> entries;
    /// Of `entries`: the first with a value that is not finite though its input is; not: there is none.
    std::optional<std::size_t> born;
};

struct Inspection {
    std::uint64_t frame_index = 0;
    double time = 0;
    std::vector<InspectedPixel> pixels;
};

/// An output of an entry, or scene_color, to be shown in an image.
struct InspectorView {
    Handle entry;  ///< of the stack that is inspected
    VkRect2D region{};
    ImageRef target;
};

class Inspector {
  public:
    Inspector(const Device& device, const InspectorDesc& desc = {});
    Inspector(Inspector&&) noexcept;
    Inspector& operator=(Inspector&&) noexcept;
    ~Inspector();

    /// Follows edits of the stack, and frames that become others: `compiled` is what the stack itself is compiled for,
    /// `frame` the next one. Compiles on a thread of its own where anything changed.
    [[nodiscard]] Result<> update(const Composer& source, const CompileDesc& compiled, const Frame& frame);
    /// Waits until what update() began has ended. For headless work.
    [[nodiscard]] Result<> wait();
    /// Records the stack as it is at the frame's time, for pixels of the frame's colour. `frame` says how images are
    /// when these commands start, so behind another recording: as that one left them; its target and watches are not
    /// used. Gives the number of the recording. At most frames_in_flight may be unfinished.
    [[nodiscard]] Result<std::uint64_t> record(VkCommandBuffer commands, const Composer& source, const Frame& frame,
                                               std::span<const VkOffset2D> pixels,
                                               std::span<const InspectorView> views = {});
    /// The next recording takes the place of the last one: histories are as before it.
    void abandon();
    /// Of a recording whose submission has finished; none: it is older than frames_in_flight, or there was no plan.
    [[nodiscard]] std::optional<Inspection> result(std::uint64_t recording) const;
    /// Why the last compile failed.
    [[nodiscard]] std::optional<Error> error() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

// An Inspector without a host: pictures in main memory, one after the other, and the values of pixels.

/// Where values that are not finite first appear in the whole picture.
struct NonFiniteBirth {
    std::optional<std::size_t> entry;  ///< of InspectedPixel::entries; none: the scene has them already
    VkOffset2D at{};                   ///< that is nearest to the pixel that was asked about, in pixels of the frame
    std::uint64_t pixels = 0;          ///< how many there are, in pixels of the frame
};

class Prober {
  public:
    /// The device must be one that the library created. Of `desc`, the target and the kernels count.
    Prober(Device& device, const DevelopDesc& desc, std::uint32_t max_pixels);
    Prober(Prober&&) noexcept;
    Prober& operator=(Prober&&) noexcept;
    ~Prober();

    /// How many can be asked about at once in such a stack.
    [[nodiscard]] static std::size_t max_pixels(const Composer& composer);
    /// Runs one frame of the stack, and waits.
    [[nodiscard]] Result<Inspection> probe(const Composer& composer, const DevelopInput& input,
                                           std::span<const VkOffset2D> pixels);
    /// Looks for them in every output of the frame that probe() ran last, which is run again for each: an effect that
    /// reads around its pixels may have brought one from far. None: all outputs are finite.
    [[nodiscard]] Result<std::optional<NonFiniteBirth>> find_birth(const Composer& composer, const DevelopInput& input,
                                                                   VkOffset2D from);

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace darkroom
