// SPDX-License-Identifier: MIT
#pragma once
// What stands for a texture in Dear ImGui: a pointer at first, a number since 1.91, and in a reference since 1.92.

#include <cstdint>
#include <type_traits>

namespace darkroom::window {

template <class Texture>
[[nodiscard]] void* address_of(const Texture& texture) {
    if constexpr (std::is_pointer_v<Texture>)
        return const_cast<void*>(static_cast<const void*>(texture));
    else if constexpr (std::is_integral_v<Texture>)
        return reinterpret_cast<void*>(static_cast<std::uintptr_t>(texture));
    else
        return address_of(texture.GetTexID());
}

}  // namespace darkroom::window
