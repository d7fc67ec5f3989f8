// SPDX-License-Identifier: MIT
#pragma once
// For tests only: the shipped scenes as the renderer draws them and their looks finish them, with rays through the same
// triangles, and what noise the occlusion leaves in them.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <darkroom/composer.hpp>
#include <darkroom/effects/ssao.hpp>
#include <darkroom/look.hpp>
#include <optional>

#include "develop/developer.hpp"
#include "image/picture/picture.hpp"
#include "render/renderer_test_support.hpp"
#include "scene/scene.hpp"
#include "ssao/ssao_truth.hpp"
#include "tests/places.hpp"

namespace darkroom::test {

/// 1920x1080, or what DARKROOM_PICTURES_SIZE says (as 960x540).
inline VkExtent2D scene_view_extent() {
    VkExtent2D out{1920, 1080};
    const char* const size = std::getenv("DARKROOM_PICTURES_SIZE");
    if (size != nullptr &&
        (std::sscanf(size, "%ux%u", &out.width, &out.height) != 2 || out.width < 64 || out.height < 64))
        ADD_FAILURE() << "DARKROOM_PICTURES_SIZE = " << size << ": is not WxH of at least 64 pixels";
    return out;
}
inline const VkExtent2D picture_extent = scene_view_extent();
inline constexpr std::array shipped_scenes{"forge", "courtyard", "dungeon", "showcase", "street", "interior"};

/// Of what is no more transparent than this.
inline TriangleMesh triangles_of(const scene::Snapshot& snapshot, const scene::Assets& assets,
                                 scene::SurfaceBlend blend = scene::SurfaceBlend::Mask) {
    TriangleMesh mesh;
    for (const scene::Instance& instance : snapshot.instances) {
        if (instance.is_wireframe || snapshot.materials[instance.material].surface.blend > blend) continue;
        const auto first = static_cast<unsigned>(mesh.points.size());
        const auto add = [&](const scene::vec3& point) { mesh.points.push_back({point.x, point.y, point.z}); };
        if (instance.mesh.model == scene::no_index) {
            const TriangleMesh box = triangles_of({{.low = {0, 0, 0}, .high = {1, 1, 1}}});
            for (const auto& [x, y, z] : box.points) add(scene::vec3(instance.world * scene::vec4(x, y, z, 1)));
            for (const unsigned corner : box.corners) mesh.corners.push_back(first + corner);
            continue;
        }
        const scene::Primitive& primitive =
            assets.models[instance.mesh.model].meshes[instance.mesh.mesh].primitives[instance.mesh.primitive];
        const auto slice = [](const auto& all, std::uint32_t begin, std::uint32_t count) {
            return begin == scene::no_index ? std::span(all).first(0) : std::span(all).subspan(begin, count);
        };
        for (const scene::vec3& point : scene::deform(
                 primitive, instance.world, slice(snapshot.joints, instance.first_joint, instance.joint_count),
                 slice(snapshot.weights, instance.first_weight, instance.weight_count)))
            add(point);
        for (const std::uint32_t index : primitive.indices) mesh.corners.push_back(first + index);
    }
    return mesh;
}

using Pixel = std::array<std::uint32_t, 2>;

/// What the renderer makes of a shipped scene, and rays through the same triangles.
class SceneView {
  public:
    explicit SceneView(const std::string& name)
        : path_(fmt::format("{}/scenes/{}.scene.toml", source_folder, name)),
          scene_(gpu::test::must(scene::read_scene(path_))),
          assets_(scene::load_assets(scene_)),
          snapshot_(scene::snapshot(scene_, assets_, {.time = scene_.time, .aspect = 16.0F / 9})),
          renderer_(gpu::test::must(render::Renderer::create(gpu::test::device(), scene_, assets_,
                                                             {.extent = picture_extent, .draw = {.has_grid = false}}))),
          shot_(render::test::shoot(renderer_, snapshot_)),
          look_(gpu::test::must(read_look(path_))),
          rays_(triangles_of(snapshot_, assets_)) {
        // A scene without its models has no noise.
        EXPECT_TRUE(assets_.warnings.empty()) << assets_.warnings.front() << "; are they built (darkroom_scenes)?";
        view.camera = renderer_.frame().camera;
        for (std::size_t i = 0; i < view.depth.pixels.size(); ++i) {
            const float* const normal = &shot_.normals.rgba[i * 4];
            view.depth.pixels[i].r = shot_.depth.rgba[i * 4];
            view.normals.pixels[i] = {normal[0], normal[1], normal[2], 0};
        }
        const ReferenceCamera camera(view.camera);
        for (std::uint32_t y = 0; y < picture_extent.height; ++y)
            for (std::uint32_t x = 0; x < picture_extent.width; ++x)
                points_.push_back(camera.world_direction(camera.view_position(
                    (x + 0.5) / picture_extent.width, (y + 0.5) / picture_extent.height, view.depth.at(x, y).r)));
        Composer composer(gpu::test::device());
        gpu::test::must(apply(look_, composer));
        const std::span<const std::uint32_t> words = composer.words(composer.find("ssao").value());
        std::memcpy(static_cast<void*>(&occlusion), words.data(), words.size_bytes());
    }

    /// Pixels within three of (x, y) that lie in one surface with it, so within a pixel's width of its plane and turned
    /// by 18 degrees at most; empty where they are few.
    [[nodiscard]] std::vector<Pixel> surface_around(std::uint32_t x, std::uint32_t y) const {
        const Double3& here = points_[y * picture_extent.width + x];
        const Rgba& normal = view.normals.at(x, y);
        const double width = 2 * view.depth.at(x, y).r / (double{view.camera.projection[0]} * picture_extent.width);
        std::vector<Pixel> out;
        for (std::uint32_t v = y - 3; v <= y + 3; ++v)
            for (std::uint32_t u = x - 3; u <= x + 3; ++u) {
                const Double3& there = points_[v * picture_extent.width + u];
                const Rgba& other = view.normals.at(u, v);
                const double over =
                    normal.r * (there[0] - here[0]) + normal.g * (there[1] - here[1]) + normal.b * (there[2] - here[2]);
                if (std::abs(over) <= width && normal.r * other.r + normal.g * other.g + normal.b * other.b >= 0.95)
                    out.push_back({u, v});
            }
        if (out.size() < 20) out.clear();
        return out;
    }

    [[nodiscard]] double truth(std::uint32_t x, std::uint32_t y) {
        float& known = traced_[y * picture_extent.width + x];
        const Rgba& normal = view.normals.at(x, y);
        if (known < 0)
            known = static_cast<float>(
                rays_.visibility(view.point(x, y), {normal.r, normal.g, normal.b}, double{occlusion.radius}, 16));
        return double{known};
    }

    /// The picture that the scene's own look makes, in codes of 255 before they are rounded, with this visibility in
    /// place of the effect's.
    [[nodiscard]] std::vector<float> finished(const ReferenceImage& visibility) {
        render::test::Pixels lit = shot_.color;
        for (std::size_t i = 0; i < visibility.pixels.size(); ++i)
            for (std::size_t channel = 0; channel < 3; ++channel)
                lit.rgba[i * 4 + channel] *= static_cast<float>(visibility.pixels[i].r);
        const gpu::test::Picture color = gpu::test::upload(gpu::test::context(), lit, VK_FORMAT_R32G32B32A32_SFLOAT,
                                                           VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
        Composer composer(gpu::test::device());
        gpu::test::must(apply(look_, composer));
        // The picture is occluded already; dither is noise of its own, and fxaa mixes in what lies beyond a surface's
        // edge.
        for (const char* const off : {"ssao", "dither", "fxaa"})
            if (const std::optional<Handle> entry = composer.find(off))
                gpu::test::must(composer.set_enabled(*entry, false));
        // What was downloaded is not as the renderer left it.
        render::Renderer renderer = gpu::test::must(renderer_.sharing(renderer_.desc()));
        gpu::test::must(renderer.prepare(snapshot_));
        Frame frame = renderer.frame();
        frame.color = {.image = color.image.handle,
                       .view = color.image.mip_views[0],
                       .format = color.image.info.format,
                       .extent = picture_extent,
                       .layout = color.layout,
                       .final_layout = color.layout};
        Developer developer(gpu::test::device(), {.target = DevelopTarget::EncodedFloat});
        const DeviceFrame input{.frame = frame,
                                .layer_usage = renderer.layer_usage(),
                                .ui = {},
                                .record_before = [&](VkCommandBuffer commands) { return renderer.record(commands); }};
        std::vector<float> codes = gpu::test::must(developer.develop(composer, input)).pixels;
        for (float& code : codes) code *= 255;
        return codes;
    }

    [[nodiscard]] const scene::Scene& scene() const { return scene_; }
    [[nodiscard]] const scene::Assets& assets() const { return assets_; }
    [[nodiscard]] const scene::Snapshot& snapshot() const { return snapshot_; }
    [[nodiscard]] const Look& look() const { return look_; }
    [[nodiscard]] Frame frame() const { return renderer_.frame(); }

    BoxView view{.depth{picture_extent.width, picture_extent.height},
                 .normals{picture_extent.width, picture_extent.height},
                 .camera{}};
    Ssao occlusion;  ///< as the scene's look has it

  private:
    std::string path_;
    scene::Scene scene_;
    scene::Assets assets_;
    scene::Snapshot snapshot_;
    render::Renderer renderer_;
    render::test::Shot shot_;
    Look look_;
    OcclusionTruth rays_;
    std::vector<Double3> points_;  ///< behind the pixels, from the eye
    std::vector<float> traced_ = std::vector<float>(view.depth.pixels.size(), -1);
};

/// How far a pixel of one channel is from the mean of these.
inline double deviation(const std::vector<float>& picture, const Pixel& pixel, const std::vector<Pixel>& around,
                        std::size_t channel) {
    const auto at = [&](const Pixel& p) {
        return double{picture[(std::size_t{p[1]} * picture_extent.width + p[0]) * 4 + channel]};
    };
    double mean = 0;
    for (const Pixel& p : around) mean += at(p) / double(around.size());
    return std::abs(at(pixel) - mean);
}

/// In codes of 255: at the 99th and the 99.9th percentile of the pixels, and at the worst one.
struct Noise {
    double usual = 0, most = 0, worst = 0;
};

inline Noise noise_of(std::vector<float> deviations) {
    std::sort(deviations.begin(), deviations.end());
    const auto percentile = [&](double share) {
        return double{deviations[static_cast<std::size_t>(share * double(deviations.size() - 1))]};
    };
    return {percentile(0.99), percentile(0.999), percentile(1)};
}

/// A pixel that stands out, and those around it.
struct Suspect {
    Pixel pixel;
    std::vector<Pixel> around;
};

/// Of the finished picture. `map`, where it is given: white is 16 codes.
inline Noise noise_of(SceneView& scene, Picture* map = nullptr) {
    const BoxView& view = scene.view;
    const ReferenceImage seen = visibility_of(scene.occlusion, view.options());
    ReferenceImage true_seen = seen;
    std::vector<Suspect> suspects;
    std::size_t count = 0;
    for (std::uint32_t y = 3; y + 3 < picture_extent.height; ++y)
        for (std::uint32_t x = 3; x + 3 < picture_extent.width; ++x) {
            if (const double depth = view.depth.at(x, y).r; !(depth > 1e-6 && depth < 1e9)) continue;
            std::vector<Pixel> around = scene.surface_around(x, y);
            if (around.empty()) continue;
            ++count;
            double mean = 0;
            for (const auto& [u, v] : around) mean += seen.at(u, v).r / double(around.size());
            // A code of visibility is hardly more than one of the picture: what is still without rays needs none.
            if (255 * std::abs(seen.at(x, y).r - mean) <= 1) continue;
            for (const auto& [u, v] : around) true_seen.at(u, v).r = scene.truth(u, v);
            suspects.push_back({{x, y}, std::move(around)});
        }
    const std::vector<float> made = scene.finished(seen), expected = scene.finished(true_seen);
    std::vector<float> deviations(count, 0.0F);
    if (map != nullptr) *map = Picture(picture_extent.width, picture_extent.height);
    for (std::size_t i = 0; i < suspects.size(); ++i) {
        const auto& [pixel, around] = suspects[i];
        for (std::size_t channel = 0; channel < 3; ++channel)
            deviations[i] = std::max(deviations[i], static_cast<float>(deviation(made, pixel, around, channel) -
                                                                       deviation(expected, pixel, around, channel)));
        if (map != nullptr) std::fill_n(map->at(pixel[0], pixel[1]), 3, deviations[i] / 16);
    }
    return noise_of(std::move(deviations));
}

}  // namespace darkroom::test
