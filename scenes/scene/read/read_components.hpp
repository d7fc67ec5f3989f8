// SPDX-License-Identifier: MIT
#pragma once
// The components of an entity, each from its table [entities.NAME.<component>]. What a component means is said in
// scene.hpp; this is only which keys it has and what they may hold.

#include <array>
#include <optional>
#include <string_view>

#include "scene/read/read_values.hpp"
#include "scene/scene.hpp"

namespace darkroom::scene::reading {

/// material.base_color_r and so on: they colour the models of an entity and of all below it.
struct BaseColor {
    std::array<std::optional<float>, 4> channels;
    [[nodiscard]] bool is_given() const { return channels[0] || channels[1] || channels[2] || channels[3]; }
};

struct EntityDraft {
    Entity entity;
    BaseColor base_color;
};

struct ComponentReader {
    std::string_view name;
    void (*read)(TableReader& table, EntityDraft& draft);
};
/// Null for a component that means nothing here.
[[nodiscard]] const ComponentReader* find_component(std::string_view name);
[[nodiscard]] std::span<const ComponentReader> all_components();

void read_camera(TableReader& table, Camera& camera);
void read_environment(TableReader& table, Environment& environment);

}  // namespace darkroom::scene::reading
