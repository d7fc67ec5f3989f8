// SPDX-License-Identifier: MIT
#include "render/pass/draw_list.hpp"

#include <algorithm>
#include <bit>
#include <glm/gtc/type_ptr.hpp>
#include <map>
#include <optional>
#include <set>
#include <tuple>

#include "render/upload/gpu_scene.hpp"

namespace darkroom::render {

namespace {

using scene::Instance;
using scene::Snapshot;
using scene::SurfaceBlend;

/// What one call cannot change: pipeline state and textures.
using SurfaceKey = std::array<std::uint32_t, 7 + 2 * scene::material_textures>;

SurfaceKey surface_key(const scene::SnapshotMaterial& material) {
    const scene::ModelMaterial& surface = material.surface;
    SurfaceKey key{};
    std::size_t next = 0;
    key[next++] = static_cast<std::uint32_t>(surface.blend);
    key[next++] = static_cast<std::uint32_t>(material.writes);
    key[next++] = surface.is_double_sided ? 1 : 0;
    key[next++] = shader_layers(surface);
    key[next++] = material.model;
    key[next++] = material.entity_texture;
    key[next++] = std::bit_cast<std::uint32_t>(texture_cutoff(material));
    for (const auto& [texture, is_srgb, is_normal] : scene::textures_of(surface)) {
        key[next++] = texture->image;
        key[next++] = static_cast<std::uint32_t>(texture->wrap_u) + 4 * static_cast<std::uint32_t>(texture->wrap_v) +
                      16 * (texture->is_nearest ? 1U : 0U);
    }
    return key;
}

/// A number for each material; equal ones have equal surfaces, and smaller ones come first.
std::vector<std::uint32_t> surface_numbers(const Snapshot& snapshot) {
    std::map<SurfaceKey, std::vector<std::uint32_t>> groups;
    for (std::uint32_t i = 0; i < snapshot.materials.size(); ++i)
        groups[surface_key(snapshot.materials[i])].push_back(i);
    std::vector<std::uint32_t> numbers(snapshot.materials.size());
    std::uint32_t number = 0;
    for (const auto& [key, members] : groups) {
        for (const std::uint32_t member : members) numbers[member] = number;
        ++number;
    }
    return numbers;
}

struct Entry {
    std::uint32_t instance = 0;
    std::uint32_t surface = 0;  ///< of surface_numbers()
    bool is_skinned = false, is_mirrored = false;
    scene::MeshId mesh;
    float distance = 0;  ///< along the view axis

    [[nodiscard]] auto state() const { return std::tie(is_skinned, is_mirrored, surface, mesh); }
};

bool is_transparent(const Snapshot& snapshot, const Instance& instance) {
    const scene::SnapshotMaterial& material = snapshot.materials[instance.material];
    const SurfaceBlend blend = material.surface.blend;
    // What only writes alpha comes after everything that may hide it.
    return material.writes == scene::Writes::Alpha || (blend != SurfaceBlend::Opaque && blend != SurfaceBlend::Mask);
}

void append(DrawList& list, std::vector<Batch>& batches, std::span<const Entry> entries, const Snapshot& snapshot) {
    const Entry* last = nullptr;
    for (const Entry& entry : entries) {
        if (last == nullptr || last->state() != entry.state()) {
            batches.push_back({.mesh = entry.mesh,
                               .first = static_cast<std::uint32_t>(list.order.size()),
                               .material = snapshot.instances[entry.instance].material,
                               .is_skinned = entry.is_skinned,
                               .is_mirrored = entry.is_mirrored});
        }
        ++batches.back().count;
        list.order.push_back(entry.instance);
        last = &entry;
    }
}

Entry make_entry(const Snapshot& snapshot, std::uint32_t index, std::span<const std::uint32_t> surfaces) {
    const Instance& instance = snapshot.instances[index];
    const scene::vec4 center(instance.bounds.center(), 1);
    const scene::mat4& view = snapshot.camera.view;
    return {.instance = index,
            .surface = surfaces[instance.material],
            .is_skinned = instance.first_joint != scene::no_index,
            .is_mirrored = instance.is_mirrored,
            .mesh = instance.mesh,
            .distance = -(view[0].z * center.x + view[1].z * center.y + view[2].z * center.z + view[3].z)};
}

void sort_by_state(std::vector<Entry>& entries) {
    std::ranges::sort(entries, [](const Entry& a, const Entry& b) {
        return std::tie(a.is_skinned, a.is_mirrored, a.surface, a.mesh, a.instance) <
               std::tie(b.is_skinned, b.is_mirrored, b.surface, b.mesh, b.instance);
    });
}

/// Within a batch the nearest first: what they hide costs no shading then. Of those in one place the last is seen.
void sort_near_to_far(std::vector<Entry>& entries) {
    sort_by_state(entries);
    for (auto first = entries.begin(); first != entries.end();) {
        const auto last =
            std::find_if(first, entries.end(), [&](const Entry& e) { return e.state() != first->state(); });
        std::sort(first, last, [](const Entry& a, const Entry& b) {
            return std::tie(a.distance, b.instance) < std::tie(b.distance, a.instance);
        });
        first = last;
    }
}

/// Two of these in one place look alike, whatever is animated.
using Place = std::array<float, 16 + 6>;

std::optional<Place> place_of_opaque(const Snapshot& snapshot, const Entry& entry) {
    const Instance& instance = snapshot.instances[entry.instance];
    const bool is_moved = entry.is_skinned || instance.first_weight != scene::no_index;
    if (is_moved || snapshot.materials[instance.material].surface.blend != SurfaceBlend::Opaque) return std::nullopt;
    Place place{};
    auto* next = std::copy_n(glm::value_ptr(instance.world), 16, place.begin());
    next = std::copy_n(glm::value_ptr(instance.bounds.low), 3, next);
    std::copy_n(glm::value_ptr(instance.bounds.high), 3, next);
    return place;
}

/// Sorts them, and drops those in the very same place as a later one, which alone is seen, nor has another shadow.
/// Tells how many were dropped.
std::uint32_t arrange_opaque(std::vector<Entry>& sorted, const Snapshot& snapshot) {
    sort_near_to_far(sorted);
    std::set<Place> seen;
    std::vector<Entry> kept;
    for (std::size_t i = 0; i < sorted.size(); ++i) {
        const Entry& entry = sorted[i];
        const auto is_beside = [&](const Entry& other) {
            return other.distance == entry.distance && other.state() == entry.state();
        };
        if (i == 0 || !is_beside(sorted[i - 1])) seen.clear();
        const bool has_neighbours = !seen.empty() || (i + 1 < sorted.size() && is_beside(sorted[i + 1]));
        const std::optional<Place> place = has_neighbours ? place_of_opaque(snapshot, entry) : std::nullopt;
        if (!place || seen.insert(*place).second) kept.push_back(entry);
    }
    std::swap(sorted, kept);
    return static_cast<std::uint32_t>(kept.size() - sorted.size());
}

}  // namespace

std::uint32_t shader_layers(const scene::ModelMaterial& surface) {
    constexpr std::uint32_t specular_bit = 1, clearcoat_bit = 2, sheen_bit = 4;
    if (surface.is_unlit) return 0;
    return (surface.specular.is_given() ? specular_bit : 0) | (surface.clearcoat.is_given() ? clearcoat_bit : 0) |
           (surface.sheen.is_given() ? sheen_bit : 0);
}

// Gribb and Hartmann, "Fast Extraction of Viewing Frustum Planes from the World-View-Projection Matrix", 2001.
Frustum::Frustum(const scene::mat4& world_to_clip) {
    const scene::mat4 rows = glm::transpose(world_to_clip);
    planes = {rows[3] + rows[0], rows[3] - rows[0], rows[3] + rows[1], rows[3] - rows[1], rows[2], rows[3] - rows[2]};
}

bool Frustum::touches(const scene::Box& box) const {
    if (box.is_empty()) return false;
    return std::ranges::all_of(planes, [&](const scene::vec4& plane) {
        const scene::vec3 furthest(plane.x >= 0 ? box.high.x : box.low.x, plane.y >= 0 ? box.high.y : box.low.y,
                                   plane.z >= 0 ? box.high.z : box.low.z);
        return plane.x * furthest.x + plane.y * furthest.y + plane.z * furthest.z + plane.w >= 0;
    });
}

DrawList draw_list(const Snapshot& snapshot, const scene::mat4& clip_moved) {
    DrawList list;
    const Frustum frustum(clip_moved * snapshot.camera.projection * snapshot.camera.view);
    const std::vector<std::uint32_t> surfaces = surface_numbers(snapshot);
    std::vector<Entry> opaque, transparent, wireframe;
    for (std::uint32_t i = 0; i < snapshot.instances.size(); ++i) {
        const Instance& instance = snapshot.instances[i];
        if (!frustum.touches(instance.bounds)) {
            ++list.culled;
            continue;
        }
        const Entry entry = make_entry(snapshot, i, surfaces);
        if (instance.is_wireframe) {
            wireframe.push_back(entry);
        } else if (is_transparent(snapshot, instance)) {
            transparent.push_back(entry);
        } else {
            opaque.push_back(entry);
        }
    }
    list.culled += arrange_opaque(opaque, snapshot);
    sort_by_state(wireframe);
    std::ranges::stable_sort(transparent, [](const Entry& a, const Entry& b) { return a.distance > b.distance; });
    append(list, list.opaque, opaque, snapshot);
    append(list, list.transparent, transparent, snapshot);
    append(list, list.wireframe, wireframe, snapshot);
    return list;
}

bool Reach::touches(const scene::Box& box) const {
    const scene::vec3 away = center - glm::clamp(center, box.low, box.high);
    return glm::dot(away, away) <= radius * radius;
}

DrawList caster_list(const Snapshot& snapshot, const scene::mat4& world_to_map, const Reach& reach) {
    DrawList list;
    const Frustum frustum(world_to_map);
    const std::vector<std::uint32_t> surfaces = surface_numbers(snapshot);
    std::vector<Entry> opaque, transparent;
    for (std::uint32_t i = 0; i < snapshot.instances.size(); ++i) {
        const Instance& instance = snapshot.instances[i];
        const bool casts = instance.casts_shadow && !instance.is_wireframe &&
                           snapshot.materials[instance.material].writes == scene::Writes::All;
        if (!casts) continue;
        if (!frustum.touches(instance.bounds) || !reach.touches(instance.bounds)) {
            ++list.culled;
            continue;
        }
        (is_transparent(snapshot, instance) ? transparent : opaque).push_back(make_entry(snapshot, i, surfaces));
    }
    list.culled += arrange_opaque(opaque, snapshot);
    sort_by_state(transparent);
    append(list, list.opaque, opaque, snapshot);
    append(list, list.transparent, transparent, snapshot);
    return list;
}

}  // namespace darkroom::render
