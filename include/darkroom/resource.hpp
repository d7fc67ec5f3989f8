// SPDX-License-Identifier: MIT
#pragma once
// Tables and pictures that a host or a look brings to a stack: what parameters of kind Resource, and wires, name. They
// are data; whoever has files reads them before (Darkroom::looks does).

#include <array>
#include <cstdint>
#include <darkroom/param.hpp>
#include <map>
#include <memory>
#include <variant>
#include <vector>

namespace darkroom {

/// A table of colours: a 1D one (a shaper), a 3D one (a cube), or the first before the second. A colour is clamped to
/// the shaper's inputs and goes through it, each channel by itself; then the same by the cube. What its numbers mean
/// (encoded, logarithmic, linear) is for its user to know.
struct ColorTable {
    std::uint32_t shaper_size = 0;                                  ///< entries; 0: none
    std::array<float, 3> shaper_min{0, 0, 0}, shaper_max{1, 1, 1};  ///< inputs of its first and last entry
    std::vector<float> shaper;                                      ///< shaper_size triples
    std::uint32_t size = 0;                                         ///< edge of the cube; 0: none
    std::array<float, 3> min{0, 0, 0}, max{1, 1, 1};                ///< inputs of its first and last entries
    std::vector<float> cube;                                        ///< size^3 triples, red runs fastest
};

/// A picture: row-major, top row first, scene-linear.
struct ResourceImage {
    std::uint32_t width = 0, height = 0;
    std::vector<float> rgba;
};

using ResourceData = std::variant<ColorTable, ResourceImage>;
/// What a look names a file for.
enum class FileUse : std::uint8_t {
    Table,    ///< a table of colours
    Numbers,  ///< a picture whose numbers count as they are in the file: masks, displacements
    Picture,  ///< a picture to be seen, scene-linear
};

/// By Resource::id.
using Resources = std::map<std::uint32_t, std::shared_ptr<const ResourceData>>;

/// Null: it names nothing.
[[nodiscard]] inline const ResourceData* find_resource(const Resources* resources, Resource resource) {
    if (resources == nullptr) return nullptr;
    const auto found = resources->find(resource.id);
    return found == resources->end() ? nullptr : found->second.get();
}
template <class Data>
[[nodiscard]] const Data* find_resource(const Resources* resources, Resource resource) {
    return std::get_if<Data>(find_resource(resources, resource));
}

}  // namespace darkroom
