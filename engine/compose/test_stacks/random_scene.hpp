// SPDX-License-Identifier: MIT
#pragma once
// For tests only: what a frame may bring beside its colour, at random: depth of any kind, normals, velocity, lights
// with and without cascades, or none of it, under any camera. The numbers are those of a scene, or broken. Not part of
// the library.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <limits>
#include <optional>

#include "compose/test_stacks/random_stack.hpp"
#include "compose/test_stacks/shadow_map.hpp"

namespace darkroom::test {

/// What a driver, a file or a host's mistake may leave in a float image.
inline float broken_number(std::mt19937& random) {
    constexpr float most = std::numeric_limits<float>::max(), infinity = std::numeric_limits<float>::infinity();
    constexpr std::array numbers{std::numeric_limits<float>::quiet_NaN(),
                                 -std::numeric_limits<float>::quiet_NaN(),
                                 infinity,
                                 -infinity,
                                 most,
                                 -most,
                                 std::numeric_limits<float>::denorm_min(),
                                 65536.0F,
                                 1e9F,
                                 -1.0F,
                                 0.0F,
                                 -0.0F,
                                 1.0F};
    return numbers[below(random, static_cast<std::uint32_t>(numbers.size()))];
}

class RandomScene {
  public:
    struct Desc {
        VkExtent2D extent{};
        bool is_broken = false;       ///< some pixels of every image hold numbers that no renderer means
        bool has_everything = false;  ///< at least depth and a light with cascades are there
    };
    RandomScene(std::mt19937& random, Device& device, const Desc& desc) : desc_(desc), context_(device.context()) {
        make_camera(random);
        if (desc.has_everything || !one_in(random, 5)) make_depth(random);
        if (one_in(random, 2)) normals_ = vectors(random, VK_FORMAT_R16G16B16A16_SFLOAT, 1);
        if (one_in(random, 3)) velocity_ = vectors(random, VK_FORMAT_R16G16_SFLOAT, 20);
        const std::uint32_t lights = desc.has_everything ? 1 + below(random, 2) : below(random, 6);
        for (std::uint32_t i = 0; i < lights; ++i) add_light(random, desc.has_everything || !one_in(random, 3));
        // A host may have promised shadows and bring none in a frame.
        has_shadows_ = !maps_.empty() || one_in(random, 2);
    }

    void tell(CompileDesc& desc) const {
        if (depth_) desc.depth.format = depth_->image.info.format;
        desc.is_depth_planar = is_planar_promised_;
        if (normals_) desc.normals.format = normals_->image.info.format;
        if (velocity_) desc.velocity.format = velocity_->image.info.format;
        desc.has_shadows = has_shadows_;
    }
    /// The scene must outlive the frame.
    void tell(Frame& frame) const {
        if (depth_) frame.depth = image_ref(*depth_);
        if (normals_) frame.normals = image_ref(*normals_);
        if (velocity_) frame.velocity = image_ref(*velocity_);
        frame.camera = camera_;
        frame.lights = lights_;
    }
    [[nodiscard]] std::string described() const {
        constexpr std::array kinds{"standard", "reversed", "planar"};
        std::string out = fmt::format(
            "\n  {}x{}{}, depth {}{}{}{}", desc_.extent.width, desc_.extent.height, desc_.is_broken ? ", broken" : "",
            depth_ ? kinds[static_cast<std::size_t>(camera_.depth)] : "none", is_planar_promised_ ? " as promised" : "",
            normals_ ? ", normals" : "", velocity_ ? ", velocity" : "");
        for (const Light& light : lights_)
            out += fmt::format(", light of {} cascades at ({}, {}, {}), volumetric {}", light.cascade_count,
                               light.direction[0], light.direction[1], light.direction[2], light.volumetric_intensity);
        return out + fmt::format("{}, projection {}, view {}", has_shadows_ ? ", shadows" : "",
                                 fmt::join(camera_.projection, " "), fmt::join(camera_.view, " "));
    }

  private:
    void make_camera(std::mt19937& random) {
        const double aspect = double{static_cast<float>(desc_.extent.width)} / desc_.extent.height;
        camera_ = look_at({between(random, -5, 5), between(random, 0.5, 5), between(random, 2, 9)},
                          {between(random, -2, 2), between(random, 0, 3), -10}, between(random, 0.3, 2), aspect);
        camera_.depth = static_cast<DepthKind>(below(random, 3));
        const float near = camera_.near_distance, far = camera_.far_distance;
        Matrix& p = camera_.projection;
        const bool is_endless = one_in(random, 4);
        if (is_endless) camera_.far_distance = std::numeric_limits<float>::infinity();
        const bool is_reversed = camera_.depth == DepthKind::Reversed;
        if (one_in(random, 6)) {
            // Orthographic: ten metres high.
            p[0] = static_cast<float>(0.2 / aspect);
            p[5] = -0.2F;
            p[10] = (is_reversed ? 1 : -1) / (far - near);
            p[11] = 0;
            p[14] = (is_reversed ? far : -near) / (far - near);
            p[15] = 1;
            camera_.far_distance = far;
        } else if (is_reversed) {
            p[10] = is_endless ? 0 : near / (far - near);
            p[14] = is_endless ? near : near * far / (far - near);
        } else if (is_endless) {
            p[10] = -1;
            p[14] = -near;
        }
        if (one_in(random, 3)) {
            camera_.is_y_down = false;
            p[5] = -p[5];
        }
        if (one_in(random, 3)) p[p[11] == 0 ? 12 : 8] = static_cast<float>(between(random, -0.1, 0.1));
    }

    /// A slope with blocks before it and sky above, at this planar distance.
    [[nodiscard]] float distance_at(std::uint32_t x, std::uint32_t y) const {
        const float u = static_cast<float>(x) / static_cast<float>(desc_.extent.width);
        const float v = static_cast<float>(y) / static_cast<float>(desc_.extent.height);
        if (x / 5 % 3 == 1 && y / 4 % 2 == 0) return 2 + 4 * u;
        return v < 0.3F ? 1e10F : 3 / (v - 0.2F) + u;
    }
    [[nodiscard]] float stored(float distance) const {
        if (camera_.depth == DepthKind::Planar) return distance;
        const Matrix& p = camera_.projection;
        if (distance >= 1e9F) return camera_.depth == DepthKind::Reversed ? 0 : 1;
        return std::clamp((p[14] - p[10] * distance) / (p[15] - p[11] * distance), 0.0F, 1.0F);
    }

    template <class Color>
    gpu::test::Picture picture(std::mt19937& random, VkFormat format, const Color& color) const {
        return gpu::test::upload(context_,
                                 gpu::test::make_pixels(desc_.extent.width, desc_.extent.height,
                                                        [&](std::uint32_t x, std::uint32_t y) {
                                                            std::array<float, 4> value = color(x, y);
                                                            if (desc_.is_broken && one_in(random, 4))
                                                                for (float& number : value)
                                                                    number = broken_number(random);
                                                            return value;
                                                        }),
                                 format, VK_IMAGE_LAYOUT_GENERAL);
    }
    void make_depth(std::mt19937& random) {
        const bool is_planar = camera_.depth == DepthKind::Planar;
        is_planar_promised_ = is_planar && one_in(random, 2);
        // A depth image holds [0, 1].
        const bool is_float = is_planar || desc_.is_broken || one_in(random, 4);
        depth_ = picture(random, is_float ? VK_FORMAT_R32_SFLOAT : VK_FORMAT_D32_SFLOAT,
                         [&](std::uint32_t x, std::uint32_t y) {
                             return std::array{stored(distance_at(x, y)), 0.0F, 0.0F, 1.0F};
                         });
    }
    gpu::test::Picture vectors(std::mt19937& random, VkFormat format, double most) const {
        return picture(random, format, [&](std::uint32_t, std::uint32_t) {
            const auto number = [&] { return static_cast<float>(between(random, -most, most)); };
            return std::array{number(), number(), number(), 0.0F};
        });
    }
    void add_light(std::mt19937& random, bool casts) {
        const auto number = [&](double low, double high) { return static_cast<float>(between(random, low, high)); };
        ReferenceLight light{.light = {.direction = {number(-1, 1), number(0.1, 1), number(-1, 1)},
                                       .color = {number(0, 4), number(0, 4), number(0, 4)},
                                       .volumetric_intensity = one_in(random, 4) ? 0 : number(0, 3),
                                       .volumetric_color = {number(0, 1), number(0, 1), number(0, 1)}},
                             .resolution = 1 + below(random, 9)};
        const std::uint32_t cascades = casts ? 1 + below(random, Light::max_cascades) : 0;
        for (std::uint32_t cascade = 0; cascade < cascades; ++cascade) {
            // Any matrix will do: the cube of so many metres around the origin, from above.
            const float scale = 0.2F / static_cast<float>(cascade + 1);
            light.light.world_to_cascade[cascade] = {scale, 0,     0, 0, 0, 0, -scale / 2, 0,
                                                     0,     scale, 0, 0, 0, 0, 0.5F,       1};
            light.light.splits[cascade] = 5.0F * static_cast<float>(cascade + 1);
            std::vector<float>& depth = light.cascades.emplace_back(std::size_t{light.resolution} * light.resolution);
            for (float& texel : depth) texel = number(0, 1);
        }
        lights_.push_back(light.light);
        if (cascades == 0) return;
        maps_.push_back(upload_shadow_map(context_, light));
        lights_.back().cascades = shadow_map_ref(maps_.back());
        lights_.back().cascade_count = cascades;
    }

    Desc desc_;
    gpu::Context& context_;
    Camera camera_;
    std::optional<gpu::test::Picture> depth_, normals_, velocity_;
    std::vector<gpu::Image> maps_;
    std::vector<Light> lights_;
    bool is_planar_promised_ = false, has_shadows_ = false;
};

}  // namespace darkroom::test
