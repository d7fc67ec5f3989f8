// SPDX-License-Identifier: MIT
#include "render/light/layers_reference.hpp"

#include "render/light/environment.hpp"
#include "render/light/shading_scene_support.hpp"
#include "render/light/shading_test_bench.hpp"
#include "shared/srgb_reference.hpp"

namespace darkroom::render {
namespace {

using namespace test;
using glm::dvec2;
using reference::LayeredSurface;

LayeredSurface reference_of(const scene::ModelMaterial& material) {
    return {.base_color = dvec3(material.base_color),
            .metallic = material.metallic,
            .roughness = material.roughness,
            .index_of_refraction = material.specular.index_of_refraction,
            .specular_weight = material.specular.weight,
            .specular_color = dvec3(material.specular.color),
            .coat_weight = material.clearcoat.weight,
            .coat_roughness = material.clearcoat.roughness,
            .sheen_color = dvec3(material.sheen.color),
            .sheen_roughness = material.sheen.roughness};
}

/// brdf_shader() as pipelines of materials with these layers have it.
std::string brdf_with(const std::string& layers) {
    std::string text = brdf_shader();
    const std::string none = "const uint layers = 0u;";
    const std::size_t place = text.find(none);
    EXPECT_NE(place, std::string::npos);
    return text.replace(place, none.size(), "const uint layers = " + layers + ";");
}

/// A sphere of the material over a floor of the same, under three lights.
void expect_lit(const scene::SnapshotMaterial& material) {
    Renderer renderer = renderer_for({.extent = frame_extent, .draw = {.has_shadows = false}}, sphere_assets());
    scene::Snapshot snapshot = sphere_and_floor(material, material);
    snapshot.lights = three_lights();
    const Shot shot = shoot(renderer, snapshot);
    const LayeredSurface surface = reference_of(material.surface);
    const auto truth = [&](const Hit& hit) {
        // The hemisphere has no mirror images: base colour stands for all that leaves, and the coat is white.
        const double part = reference::coat_part(surface, hit.normal, hit.to_camera);
        const dvec3 base = reference::with_white_sheen(surface, surface.base_color, hit.facing);
        dvec3 light =
            glm::mix(base, dvec3(1), part) * reference::hemisphere(hit.normal, {0.12, 0.13, 0.18}, {0.06, 0.05, 0.04}) +
            dvec3(material.surface.emissive) * (1 - part);
        for (const scene::LightState& lamp : snapshot.lights) {
            const Arriving arrives = arriving_light(lamp, hit.position);
            light +=
                arrives.color * reference::reflected(surface, hit.normal, hit.normal, hit.to_camera, arrives.direction);
        }
        return light;
    };
    // As in RenderGpuShadingScene.SphereAndFloorInPerspectiveHaveTheirClosedForms.
    expect_hits(shot.color, truth, 0.01, 0.002, 1e-3);
}

dvec2 scale_and_bias_at(const Picture& table, double n_dot_v, double roughness) {
    const auto place = [&](double t) { return std::clamp(t * table.width - 0.5, 0.0, table.width - 1.001); };
    const double x = place(n_dot_v), y = place(roughness);
    const auto left = static_cast<std::uint32_t>(x), top = static_cast<std::uint32_t>(y);
    const auto texel = [&](std::uint32_t i, std::uint32_t j) { return dvec2(table.at(i, j)[0], table.at(i, j)[1]); };
    return glm::mix(glm::mix(texel(left, top), texel(left + 1, top), x - left),
                    glm::mix(texel(left, top + 1), texel(left + 1, top + 1), x - left), y - top);
}

/// The same in a white sky, without lights.
void expect_in_white_sky(const scene::SnapshotMaterial& material) {
    scene::Assets assets = sphere_assets();
    assets.skybox.emplace(32, 16);
    std::ranges::fill(assets.skybox->pixels, 1.0F);
    Renderer renderer = renderer_for({.extent = frame_extent, .draw = {.has_shadows = false}}, assets);
    const Shot shot = shoot(renderer, sphere_and_floor(material, material));
    const LayeredSurface surface = reference_of(material.surface);
    const Picture table = split_sum_table(64);
    const auto truth = [&](const Hit& hit) {
        const dvec2 scale_and_bias = scale_and_bias_at(table, hit.facing, surface.roughness);
        return reference::reflected_white(surface, hit.normal, hit.to_camera, scale_and_bias);
    };
    // The table has half floats and 64 steps, over which it bends most at grazing angles.
    expect_hits(shot.color, truth, 0.005, 0.005, 3e-3);
}

scene::SnapshotMaterial with_specular(scene::SnapshotMaterial material, const scene::SpecularLayer& layer) {
    material.surface.specular = layer;
    return material;
}

const scene::SnapshotMaterial& paint() {
    static const scene::SnapshotMaterial material = material_of({0.5F, 0.4F, 0.3F}, 0, 0.45F);
    return material;
}

TEST(RenderGpuLayers, IndexOfRefractionSaysWhatIsReflectedHeadOn) {
    for (const float index : {0.0F, 1.0F, 1.33F, 2.4F}) {
        expect_lit(with_specular(paint(), {.index_of_refraction = index}));
        expect_in_white_sky(with_specular(paint(), {.index_of_refraction = index}));
    }
}

TEST(RenderGpuLayers, SpecularHasWeightAndColor) {
    for (const float weight : {0.0F, 0.5F, 1.0F}) {
        const scene::SpecularLayer layer{.index_of_refraction = 1.8F, .weight = weight, .color = {1, 0.3F, 4}};
        expect_lit(with_specular(paint(), layer));
        expect_in_white_sky(with_specular(paint(), layer));
    }
}

TEST(RenderGpuLayers, MetalsDoNotCareForSpecular) {
    const scene::SnapshotMaterial gold = material_of({0.9F, 0.7F, 0.3F}, 1, 0.45F);
    expect_lit(with_specular(gold, {.index_of_refraction = 2, .weight = 0.2F, .color = {1, 0, 0}}));
    expect_in_white_sky(with_specular(gold, {.index_of_refraction = 2, .weight = 0.2F, .color = {1, 0, 0}}));
}

TEST(RenderGpuLayers, WhiteUnderAWeakLayerIsWhiteInAWhiteSky) {
    for (const float weight : {0.0F, 0.3F, 1.0F})
        for (const float index : {0.0F, 1.2F, 2.4F}) {
            const scene::SnapshotMaterial white =
                with_specular(material_of(vec3(1), 0, 0.5F), {.index_of_refraction = index, .weight = weight});
            expect_in_white_sky(white);
            EXPECT_NEAR(reference::reflected_white_base(reference_of(white.surface), {0.7, 0.1}).x, 1, 1e-12);
        }
}

/// A model whose one material has these textures, all of them of one pixel.
scene::Assets assets_with_pixel(const scene::ModelMaterial& material, std::array<std::uint8_t, 4> rgba) {
    scene::Assets assets = sphere_assets();
    assets.models[0].images.push_back(
        {.name = "pixel", .width = 1, .height = 1, .rgba = std::vector<std::uint8_t>(rgba.begin(), rgba.end())});
    assets.models[0].materials.push_back(material);
    return assets;
}

/// With textures, a material is drawn as one whose factors are what both multiply to.
void expect_same(const scene::ModelMaterial& textured, std::array<std::uint8_t, 4> rgba,
                 const scene::SnapshotMaterial& factors) {
    const auto picture = [&](const scene::SnapshotMaterial& material) {
        Renderer renderer =
            renderer_for({.extent = frame_extent, .draw = {.has_shadows = false}}, assets_with_pixel(textured, rgba));
        scene::Snapshot snapshot = sphere_and_floor(material, material);
        snapshot.lights = three_lights();
        return shoot(renderer, snapshot).color;
    };
    scene::SnapshotMaterial given;
    given.model = 0;
    given.surface = textured;
    const Pixels with_textures = picture(given), with_factors = picture(factors);
    for_each_hit([&](std::uint32_t x, std::uint32_t y, const Hit&) {
        const auto color = with_factors.at(x, y);
        // Sampling rounds sRGB to a few parts of ten thousand, and the target has half floats.
        expect_color(with_textures, x, y, dvec3(color[0], color[1], color[2]), 2e-3, 1e-3);
    });
}

scene::SnapshotMaterial with_clearcoat(scene::SnapshotMaterial material, float weight, float roughness) {
    material.surface.clearcoat.weight = weight;
    material.surface.clearcoat.roughness = roughness;
    return material;
}

TEST(RenderGpuLayers, ClearcoatTakesItsPartOfAllThatIsUnderIt) {
    scene::SnapshotMaterial glowing = paint();
    glowing.surface.emissive = {0.5F, 0.25F, 0};
    const scene::SnapshotMaterial gold = material_of({0.9F, 0.7F, 0.3F}, 1, 0.6F);
    for (const float weight : {0.3F, 1.0F}) {
        expect_lit(with_clearcoat(glowing, weight, 0.35F));
        expect_lit(with_clearcoat(gold, weight, 0.5F));
        expect_in_white_sky(with_clearcoat(paint(), weight, 0.2F));
        expect_in_white_sky(with_clearcoat(gold, weight, 0.7F));
    }
    // All layers at once.
    expect_lit(with_clearcoat(with_specular(glowing, {.index_of_refraction = 1.8F, .weight = 0.5F}), 0.8F, 0.4F));
}

scene::SnapshotMaterial with_sheen(scene::SnapshotMaterial material, vec3 color, float roughness) {
    material.surface.sheen.color = color;
    material.surface.sheen.roughness = roughness;
    return material;
}

TEST(RenderGpuLayers, SheenIsWhatTheReferenceHas) {
    for (const float roughness : {0.0F, 0.3F, 1.0F}) {
        const scene::SnapshotMaterial cloth = with_sheen(paint(), {0.8F, 0.3F, 0}, roughness);
        expect_lit(cloth);
        expect_lit(with_clearcoat(cloth, 0.7F, 0.4F));
        expect_in_white_sky(cloth);
    }
    // White fibres on a white surface, in a white sky: no light is lost, and none made.
    const LayeredSurface white{.base_color = dvec3(1), .sheen_color = dvec3(1), .sheen_roughness = 0.4};
    EXPECT_NEAR(reference::with_white_sheen(white, dvec3(1), 0.3).x, 1, 1e-12);
}

// By the midpoint rule over directions of light.
TEST(RenderLayers, SheenAlbedoIsTheIntegralOfTheSheen) {
    constexpr int steps = 200;
    double squares = 0, count = 0;
    for (const double roughness : {0.1, 0.2, 0.35, 0.5, 0.75, 1.0})
        for (const double cosine : {0.05, 0.2, 0.4, 0.6, 0.8, 1.0}) {
            const dvec3 v(std::sqrt(1 - cosine * cosine), 0, cosine);
            double sum = 0;
            for (int i = 0; i < steps; ++i)
                for (int j = 0; j < steps; ++j) {
                    const double height = (i + 0.5) / steps, angle = (j + 0.5) / steps * std::numbers::pi;
                    const double across = std::sqrt(1 - height * height);
                    sum += reference::sheen_highlight(roughness, {0, 0, 1}, v,
                                                      {across * std::cos(angle), across * std::sin(angle), height});
                }
            const double truth = std::min(sum * 2 * std::numbers::pi / (steps * steps), 1.0);
            const double error = reference::sheen_albedo(cosine, roughness) - truth;
            EXPECT_NEAR(error, 0, 0.042) << roughness << ", " << cosine;
            squares += error * error, ++count;
        }
    EXPECT_LT(std::sqrt(squares / count), 0.0125);
}

TEST(RenderGpuLayers, SheenTexturesMultiply) {
    const std::array<std::uint8_t, 4> rgba{255, 128, 0, 51};
    scene::SnapshotMaterial textured = with_sheen(paint(), {1, 0.5F, 1}, 0.5F);
    textured.surface.sheen.color_texture.image = 0;
    const auto green = static_cast<float>(srgb_decoded(128 / 255.0));
    expect_same(textured.surface, rgba, with_sheen(paint(), {1, 0.5F * green, 0}, 0.5F));
    textured.surface.sheen.color_texture.image = scene::no_index;
    textured.surface.sheen.roughness_texture.image = 0;
    textured.surface.sheen.roughness = 1;
    expect_same(textured.surface, rgba, with_sheen(paint(), {1, 0.5F, 1}, 0.2F));
}

TEST(RenderGpuLayers, ClearcoatTexturesMultiply) {
    const std::array<std::uint8_t, 4> rgba{51, 102, 0, 255};
    scene::SnapshotMaterial textured = with_clearcoat(paint(), 1, 0.4F);
    textured.surface.clearcoat.texture.image = 0;
    expect_same(textured.surface, rgba, with_clearcoat(paint(), 0.2F, 0.4F));
    textured.surface.clearcoat.texture.image = scene::no_index;
    textured.surface.clearcoat.roughness_texture.image = 0;
    textured.surface.clearcoat.roughness = 0.9F;
    expect_same(textured.surface, rgba, with_clearcoat(paint(), 1, 0.36F));
}

TEST(RenderGpuLayers, ClearcoatHasItsOwnNormal) {
    FragmentBench bench(Shape::Plane);
    bench.material.base_color = vec4(0.5, 0.4, 0.3, 1);
    bench.material.factors.y = 0.5F;
    bench.material.clearcoat = vec4(0.9, 0.3, 0.5, 0);
    const dvec3 light = glm::normalize(dvec3(1, 0.8, -0.3));
    bench.frame.light_counts.x = 1;
    bench.lights.directional_direction[0] = vec4(light, -1);
    bench.lights.directional_color[0] = vec4(2, 3, 4, 0);
    const LayeredSurface surface{.base_color = dvec3(bench.material.base_color),
                                 .roughness = 0.5,
                                 .coat_weight = bench.material.clearcoat.x,
                                 .coat_roughness = bench.material.clearcoat.y};
    const auto expect_normals = [&](const dvec3& n, const dvec3& coat_normal) {
        const auto [r, g, b, a] = bench.draw({.has_textures = 1, .layers = 2}).color.at(20, 40);
        const dvec3 truth = dvec3(2, 3, 4) * reference::reflected(surface, n, coat_normal, {0, 1, 0}, light);
        expect_close({{r, g, b, a}}, {truth}, 2e-5, 0);
    };
    // u is along x and v along z, so the texel's y, which points up in the picture, is along -z.
    const dvec3 base_normal = glm::normalize(dvec3(-0.3, 1, 0.2)), flat(0, 1, 0);
    bench.textures[2] = FragmentBench::one(vec4(vec3(-0.3F, -0.2F, 1) * 0.5F + 0.5F, 1));
    bench.textures[9] = FragmentBench::one(vec4(vec3(0.8F, 0.4F, 1) * 0.5F + 0.5F, 1));
    bench.material.flags.y = 1U << 2;
    expect_normals(base_normal, flat);
    bench.material.flags.y = 1U << 2 | 1U << 9;
    expect_normals(base_normal, glm::normalize(dvec3(0.4, 1, -0.2)));
    bench.material.flags.y = 1U << 9;
    expect_normals(flat, glm::normalize(dvec3(0.4, 1, -0.2)));
}

TEST(RenderGpuLayers, SpecularTexturesMultiply) {
    const std::array<std::uint8_t, 4> rgba{255, 128, 0, 51};
    scene::SnapshotMaterial textured = with_specular(paint(), {.index_of_refraction = 2.4F, .color = {1, 3, 1}});
    textured.surface.specular.color_texture.image = 0;
    const auto half = static_cast<float>(srgb_decoded(128 / 255.0));
    expect_same(textured.surface, rgba,
                with_specular(paint(), {.index_of_refraction = 2.4F, .color = {1, 3 * half, 0}}));
    textured.surface.specular.texture.image = 0;
    textured.surface.specular.color_texture.image = scene::no_index;
    expect_same(textured.surface, rgba,
                with_specular(paint(), {.index_of_refraction = 2.4F, .weight = 0.2F, .color = {1, 3, 1}}));
}

TEST(RenderGpuLayers, SpecularAgreesWithTheReference) {
    Directions random(5);
    std::vector<std::vector<vec4>> inputs(5);
    std::vector<dvec3> truth;
    for (int i = 0; i < 4096; ++i) {
        const auto number = [&] { return static_cast<float>(random.number()); };
        const dvec3 n = random.on_sphere(), v = random.around(n);
        const dvec3 mirrored = n * (2 * glm::dot(n, v)) - v;
        const dvec3 l = i % 2 == 0 ? random.around(n) : glm::normalize(mirrored + random.on_sphere() * 0.02);
        inputs[0].emplace_back(n, 0.1F + 0.9F * number());
        inputs[1].emplace_back(v, 1 + 2 * number());
        inputs[2].emplace_back(l, number());
        inputs[3].emplace_back(number(), number(), number(), i % 4 < 2 ? 0 : number());
        inputs[4].emplace_back(2 * number(), 2 * number(), 2 * number(), 0);
        const auto given = [&](std::size_t input) { return glm::normalize(dvec3(inputs[input].back())); };
        truth.push_back(reference::reflected_base(LayeredSurface{.base_color = dvec3(inputs[3].back()),
                                                                 .metallic = inputs[3].back().w,
                                                                 .roughness = inputs[0].back().w,
                                                                 .index_of_refraction = inputs[1].back().w,
                                                                 .specular_weight = inputs[2].back().w,
                                                                 .specular_color = dvec3(inputs[4].back())},
                                                  given(0), given(1), given(2)));
    }
    const std::vector<vec4> device = evaluate("specular", brdf_with("1u") + R"(
vec4 shade(Pixel pixel) {
    vec4 n = load(input_0, pixel.texel), v = load(input_1, pixel.texel), l = load(input_2, pixel.texel);
    vec4 material = load(input_3, pixel.texel);
    float root = (v.w - 1.0) / (v.w + 1.0);
    Reflectance surface = reflectance_with_specular(material.rgb, material.a, n.w,
                                                    load(input_4, pixel.texel).rgb * root * root, l.w);
    return vec4(reflected(surface, n.xyz, v.xyz, l.xyz), 1.0);
}
)",
                                              inputs);
    // As in RenderGpuBrdf.ShaderAgreesWithTheReference.
    expect_close(device, truth, 5e-4, 1e-6);
}

}  // namespace
}  // namespace darkroom::render
