// SPDX-License-Identifier: MIT
#pragma once
// What names an entry of a Composer's stack, and a parameter of one.

#include <cstdint>

namespace darkroom {

/// An entry of a stack, and its output as an input for others. A default one is "the output of the entry before". No
/// number is given twice, in any Composer: the handle of an entry that was removed names nothing.
struct Handle {
    std::uint32_t id = 0;
    bool is_previous = false;
    [[nodiscard]] bool is_given() const { return id != 0; }
    /// The same picture one frame before: an input for any entry, also for those before the one that makes it. Black
    /// where there was no such frame. Read as `input` it is brought to the scene's size.
    [[nodiscard]] Handle previous() const { return {id, true}; }
    friend bool operator==(Handle, Handle) = default;
};
/// The scene colour as the host gives it: an input for any entry.
inline constexpr Handle scene_color{~0u};
/// The alpha of the scene colour as a grey picture: what a scene marks with its alpha is a layer of its own.
inline constexpr Handle scene_alpha{~0u - 1};

/// The interface's image, Frame::ui: encoded, premultiplied.
inline constexpr Handle ui_layer{~0u - 2};

/// A parameter of one entry: see Composer::parameter(). Another effect in the entry's place has others.
struct ParameterId {
    std::uint32_t owner = 0;  ///< 0: none
    std::uint16_t row = 0;    ///< of the effect's rows
    std::uint16_t place = 0;  ///< where the entry was when it was found, which is looked at first
};

}  // namespace darkroom
