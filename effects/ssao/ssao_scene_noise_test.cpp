// SPDX-License-Identifier: MIT
// What noise the occlusion leaves in the shipped scenes, as the renderer draws them: of every pixel, how far it is from
// the mean of the pixels around on its surface, beyond what rays say of the same pixels.
// Where DARKROOM_PICTURES names a folder, it gets a map of each scene: white is 16 codes of 255.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <darkroom/effects/ssao.hpp>
#include <filesystem>
#include <optional>

#include "image/picture/write.hpp"
#include "render/renderer_test_support.hpp"
#include "scene/scene.hpp"
#include "ssao/ssao_truth.hpp"
#include "tests/places.hpp"

namespace darkroom {
namespace {

constexpr VkExtent2D full_hd{1920, 1080};

test::TriangleMesh triangles_of(const scene::Snapshot& snapshot, const scene::Assets& assets) {
    test::TriangleMesh mesh;
    for (const scene::Instance& instance : snapshot.instances) {
        if (instance.is_wireframe || snapshot.materials[instance.material].surface.blend > scene::SurfaceBlend::Mask)
            continue;
        const auto first = static_cast<unsigned>(mesh.points.size());
        const auto add = [&](const scene::vec3& point) { mesh.points.push_back({point.x, point.y, point.z}); };
        if (instance.mesh.model == scene::no_index) {
            const test::TriangleMesh box = test::triangles_of({{.low = {0, 0, 0}, .high = {1, 1, 1}}});
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

/// Pixels of the surface of (x, y) within three of it; empty where they are few.
std::vector<std::array<std::uint32_t, 2>> surface_around(const test::BoxView& view, std::uint32_t x, std::uint32_t y) {
    const auto depth = [&](std::uint32_t column, std::uint32_t row) { return view.depth.at(column, row).r; };
    const double here = depth(x, y);
    const auto slope = [&](double before, double after) {
        return std::abs(here - before) < std::abs(after - here) ? here - before : after - here;
    };
    const double across = slope(depth(x - 1, y), depth(x + 1, y)), down = slope(depth(x, y - 1), depth(x, y + 1));
    const Rgba& normal = view.normals.at(x, y);
    std::vector<std::array<std::uint32_t, 2>> out;
    for (int j = -3; j <= 3; ++j)
        for (int i = -3; i <= 3; ++i) {
            const std::uint32_t u = x + static_cast<std::uint32_t>(i), v = y + static_cast<std::uint32_t>(j);
            const Rgba& other = view.normals.at(u, v);
            if (std::abs(depth(u, v) - here - across * i - down * j) <= 0.005 * here &&
                normal.r * other.r + normal.g * other.g + normal.b * other.b >= 0.95)
                out.push_back({u, v});
        }
    if (out.size() < 20) out.clear();
    return out;
}

/// What the renderer makes of a shipped scene, and rays through the same triangles.
class SceneView {
  public:
    explicit SceneView(const std::string& name) {
        const scene::Scene scene =
            gpu::test::must(scene::read_scene(fmt::format("{}/scenes/{}.scene.toml", test::source_folder, name)));
        const scene::Assets assets = scene::load_assets(scene);
        const scene::Snapshot snapshot = scene::snapshot(scene, assets, {.aspect = 16.0F / 9});
        render::Renderer renderer = gpu::test::must(
            render::Renderer::create(gpu::test::device(), scene, assets,
                                     {.extent = full_hd, .draw = {.has_shadows = false, .has_grid = false}}));
        const render::test::Shot shot = render::test::shoot(renderer, snapshot);
        view.camera = renderer.frame().camera;
        for (std::size_t i = 0; i < view.depth.pixels.size(); ++i) {
            const float* const normal = &shot.normals.rgba[i * 4];
            view.depth.pixels[i].r = shot.depth.rgba[i * 4];
            view.normals.pixels[i] = {normal[0], normal[1], normal[2], 0};
        }
        rays_.emplace(triangles_of(snapshot, assets));
    }

    [[nodiscard]] double truth(std::uint32_t x, std::uint32_t y) {
        float& known = traced_[y * full_hd.width + x];
        const Rgba& normal = view.normals.at(x, y);
        if (known < 0)
            known = static_cast<float>(
                rays_->visibility(view.point(x, y), {normal.r, normal.g, normal.b}, double{Ssao{}.radius}, 16));
        return double{known};
    }

    test::BoxView view{.depth{full_hd.width, full_hd.height}, .normals{full_hd.width, full_hd.height}, .camera{}};

  private:
    std::optional<test::OcclusionTruth> rays_;
    std::vector<float> traced_ = std::vector<float>(view.depth.pixels.size(), -1);
};

/// In codes of 255.
struct Noise {
    double usual = 0, most = 0;  ///< at the 99th and the 99.9th percentile
};

Noise noise_of(const std::string& name) {
    SceneView scene(name);
    const test::BoxView& view = scene.view;
    const ReferenceImage seen = test::visibility_of({}, view.options());
    std::vector<double> deviations;
    Picture map(full_hd.width, full_hd.height);
    for (std::uint32_t y = 3; y + 3 < full_hd.height; ++y)
        for (std::uint32_t x = 3; x + 3 < full_hd.width; ++x) {
            if (const double depth = view.depth.at(x, y).r; !(depth > 1e-6 && depth < 1e9)) continue;
            const auto around = surface_around(view, x, y);
            if (around.empty()) continue;
            double mean = 0;
            for (const auto& [u, v] : around) mean += seen.at(u, v).r / double(around.size());
            double deviation = 255 * std::abs(seen.at(x, y).r - mean);
            // What is still without rays needs none.
            if (deviation > 1) {
                double expected = 0;
                for (const auto& [u, v] : around) expected += scene.truth(u, v) / double(around.size());
                deviation = std::max(0.0, deviation - 255 * std::abs(scene.truth(x, y) - expected));
            }
            deviations.push_back(deviation);
            std::fill_n(map.at(x, y), 3, static_cast<float>(deviation / 16));
        }
    std::sort(deviations.begin(), deviations.end());
    const auto percentile = [&](double share) {
        return deviations[static_cast<std::size_t>(share * double(deviations.size() - 1))];
    };
    const Noise out{percentile(0.99), percentile(0.999)};
    fmt::print("{}: 99th percentile {:.2f}, 99.9th {:.2f}, worst {:.2f}\n", name, out.usual, out.most,
               deviations.back());
    if (const char* const folder = std::getenv("DARKROOM_PICTURES"))
        gpu::test::must(write_picture(std::filesystem::path(folder) / (name + "_noise.png"), map));
    return out;
}

// What a wish for less is measured against: 2 codes at the 99.9th percentile. With one tile alone forge has 3.8
// and 12.9.
TEST(SoakGpuSsaoNoise, OfTheShippedScenes) {
    for (const char* const name : {"forge", "courtyard", "dungeon", "showcase"}) {
        const Noise noise = noise_of(name);
        EXPECT_LE(noise.usual, 2) << name;
        EXPECT_LE(noise.most, 8.5) << name;
    }
}

// What lies flat under the light is where occlusion shows as dirt. Of the showcase's floor hardly anything is hidden.
TEST(SoakGpuSsaoNoise, FloorsAreNearerToRaysThanByTheHemisphere) {
    for (const char* const name : {"forge", "courtyard", "dungeon"}) {
        SceneView scene(name);
        const ReferenceImage made = test::visibility_of({}, scene.view.options());
        const ReferenceImage points = test::visibility_of({.method = SsaoMethod::Hemisphere}, scene.view.options());
        double count = 0, truth = 0, seen = 0, seen_by_points = 0, error = 0, error_of_points = 0;
        for (std::uint32_t y = 0; y < full_hd.height; y += 5)
            for (std::uint32_t x = 0; x < full_hd.width; x += 5) {
                if (scene.view.normals.at(x, y).g < 0.95) continue;
                const double expected = scene.truth(x, y);
                count += 1;
                truth += expected;
                seen += made.at(x, y).r;
                seen_by_points += points.at(x, y).r;
                error += std::abs(made.at(x, y).r - expected);
                error_of_points += std::abs(points.at(x, y).r - expected);
            }
        fmt::print("{}: floors {:.4f} by rays, {:.4f}, {:.4f} by the hemisphere; error {:.4f}, {:.4f}\n", name,
                   truth / count, seen / count, seen_by_points / count, error / count, error_of_points / count);
        EXPECT_LT(error, error_of_points) << name;
    }
}

}  // namespace
}  // namespace darkroom
