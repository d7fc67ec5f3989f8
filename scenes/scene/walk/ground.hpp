// SPDX-License-Identifier: MIT
#pragma once
// What stands still in a scene, as triangles that rays can meet: boxes and meshes of any material. What moves, bends or
// only writes a mask is passed through, and so are rooms, sprites and particles. Made once for a scene, in a grid seen
// from above, so that a ray asks few triangles; not for rays that are long and level.

#include <cstdint>
#include <optional>
#include <vector>

#include "scene/pose/snapshot.hpp"

namespace darkroom::scene {

struct RayHit {
    float distance = 0;
    vec3 normal{0, 1, 0};  ///< of unit length, to the side that the ray comes from
};

class Ground {
  public:
    /// Of them it holds no more, which is 52 MiB: a mesh that has no room is its box, and one beyond that is not there.
    static constexpr std::size_t max_triangles = std::size_t{1} << 20, max_links = std::size_t{1} << 22;

    Ground() = default;
    Ground(const Scene& scene, const Assets& assets);

    /// The nearest triangle within `reach` metres. `direction` is of unit length.
    [[nodiscard]] std::optional<RayHit> cast(vec3 from, vec3 direction, float reach) const;
    [[nodiscard]] const Box& bounds() const { return bounds_; }
    [[nodiscard]] std::size_t triangle_count() const { return triangles_.size(); }
    [[nodiscard]] std::size_t link_count() const { return links_.size(); }  ///< of triangles and cells

  private:
    struct Triangle {
        vec3 corner{0}, first_edge{0}, second_edge{0};
    };
    struct Cells {
        std::uint32_t low_x = 0, high_x = 0, low_z = 0, high_z = 0;
        [[nodiscard]] std::size_t count() const {
            return (std::size_t{high_x} - low_x + 1) * (std::size_t{high_z} - low_z + 1);
        }
    };
    void add(const std::vector<vec3>& points, const std::vector<std::uint32_t>& indices);
    void link();
    [[nodiscard]] Cells cells_of(const Box& box) const;
    [[nodiscard]] static Box bounds_of(const Triangle& triangle);

    std::vector<Triangle> triangles_;
    Box bounds_;
    std::uint32_t side_ = 1;            ///< cells along x, and along z
    std::vector<std::uint32_t> first_;  ///< of each cell in links_, and the end
    std::vector<std::uint32_t> links_;  ///< triangles, cell by cell
};

}  // namespace darkroom::scene
