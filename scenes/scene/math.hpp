// SPDX-License-Identifier: MIT
#pragma once
// The vectors and matrices of scenes are GLM's, set up once: column-major, right-handed, y up, depth in [0, 1]. The
// camera looks along -z. Matrices pass into darkroom/frame.hpp number by number. No other file includes GLM: its macros
// change how vectors are passed, and files that disagree link without a word.

#define GLM_FORCE_RADIANS
#define GLM_FORCE_DEPTH_ZERO_TO_ONE
#define GLM_FORCE_CTOR_INIT
#define GLM_ENABLE_EXPERIMENTAL
#include <glm/glm.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/packing.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>

#include <algorithm>
#include <array>

namespace darkroom::scene {

using glm::mat3;
using glm::mat4;
using glm::quat;
using glm::uvec4;
using glm::vec2;
using glm::vec3;
using glm::vec4;

/// Axis-aligned box; empty while low > high.
struct Box {
    vec3 low{1e30F}, high{-1e30F};
    [[nodiscard]] bool is_empty() const { return low.x > high.x; }
    void add(vec3 point) {
        low = glm::min(low, point);
        high = glm::max(high, point);
    }
    void add(const Box& other) {
        low = glm::min(low, other.low);
        high = glm::max(high, other.high);
    }
    [[nodiscard]] vec3 center() const { return (low + high) * 0.5F; }
    [[nodiscard]] vec3 size() const { return high - low; }
};

/// The box around a transformed box; an empty one stays empty.
[[nodiscard]] inline Box transformed(const Box& box, const mat4& matrix) {
    Box out;
    if (box.is_empty()) return out;
    for (int corner = 0; corner < 8; ++corner) {
        const vec3 point((corner & 1) != 0 ? box.high.x : box.low.x, (corner & 2) != 0 ? box.high.y : box.low.y,
                         (corner & 4) != 0 ? box.high.z : box.low.z);
        out.add(vec3(matrix * vec4(point, 1)));
    }
    return out;
}

struct Transform {
    vec3 position{0};
    quat rotation{1, 0, 0, 0};  ///< w, x, y, z
    vec3 scale{1};
    [[nodiscard]] mat4 matrix() const {
        return glm::scale(glm::translate(mat4(1), position) * glm::mat4_cast(rotation), scale);
    }
};

}  // namespace darkroom::scene
