// SPDX-License-Identifier: MIT
#include "render/pass/mesh_pass.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/constants.hpp>

#include "render/renderer_test_support.hpp"

namespace darkroom::render {
namespace {

using namespace test;
using scene::SurfaceBlend;

constexpr VkExtent2D small{64, 48};

std::array<float, 4> middle(const Pixels& pixels) { return pixels.at(32, 24); }

void expect_near(const std::array<float, 4>& found, const std::array<float, 4>& wanted, float tolerance) {
    for (std::size_t c = 0; c < 4; ++c) EXPECT_NEAR(found[c], wanted[c], tolerance) << "channel " << c;
}

/// A model of one mesh, drawn by one instance.
scene::Assets assets_of(scene::Primitive primitive) {
    scene::Assets assets;
    assets.models.resize(1);
    assets.models[0].meshes.push_back({.primitives = {std::move(primitive)}});
    return assets;
}

/// A triangle of 2 m in front of the camera, counter-clockwise.
scene::Primitive triangle(float distance = 4) {
    scene::Primitive primitive;
    for (const vec3& position : {vec3(-1, -1, -distance), vec3(1, -1, -distance), vec3(0, 1, -distance)})
        primitive.vertices.push_back({.position = position, .normal = vec3(0, 0, 1)});
    primitive.indices = {0, 1, 2};
    return primitive;
}

scene::Snapshot snapshot_of_model(const scene::SnapshotMaterial& material) {
    scene::Snapshot snapshot = snapshot_of(small);
    snapshot.materials = {material};
    snapshot.instances = {{.mesh = {0, 0, 0}, .bounds = {vec3(-3, -3, -6), vec3(3, 3, -2)}}};
    return snapshot;
}

TEST(RenderGpuMesh, BlendsAreTheirArithmetic) {
    struct Case {
        SurfaceBlend blend;
        vec3 wanted;
    };
    const vec3 back(0.5F, 2, 1), front(4, 0.25F, 1);
    const float alpha = 0.25F;
    for (const Case& one : {Case{SurfaceBlend::Alpha, front * alpha + back * (1 - alpha)},
                            {SurfaceBlend::Additive, front * alpha + back},
                            {SurfaceBlend::Multiply, front * back + back * (1 - alpha)}}) {
        Renderer renderer = renderer_for({.extent = small});
        scene::Snapshot snapshot = snapshot_of(small);
        add_wall(snapshot, 8, 6, plain(vec4(back, 1)));
        scene::SnapshotMaterial glass = plain(vec4(front, 0.5F), one.blend);
        glass.opacity = 0.5F;
        add_wall(snapshot, 4, 1, glass);
        const Shot shot = shoot(renderer, snapshot);
        expect_near(middle(shot.color), {one.wanted.r, one.wanted.g, one.wanted.b, 1}, 4e-3F);
        EXPECT_NEAR(middle(shot.depth)[0], 8, 1e-3F) << "what is blended is not in the layers";
    }
}

TEST(RenderGpuMesh, TransparentOnesAreLaidOverFromBackToFront) {
    Renderer renderer = renderer_for({.extent = small});
    scene::Snapshot snapshot = snapshot_of(small);
    add_wall(snapshot, 4, 1, plain({1, 0, 0, 0.5F}, SurfaceBlend::Alpha));
    add_wall(snapshot, 8, 6, plain({0, 1, 0, 0.5F}, SurfaceBlend::Alpha));
    add_wall(snapshot, 12, 9, plain({0, 0, 1, 1}));
    // A box is seen by its front face alone.
    expect_near(middle(shoot(renderer, snapshot).color), {0.5F, 0.25F, 0.25F, 1}, 2e-3F);
}

TEST(RenderGpuMesh, TheAlphaLayerIsWrittenByThoseDrawsAloneThatAskForIt) {
    scene::Scene scene;
    scene.has_alpha_layer = true;
    Renderer renderer = renderer_for({.extent = small}, {}, scene);
    scene::Snapshot snapshot = snapshot_of(small);
    add_wall(snapshot, 8, 6, plain({0.5F, 0.25F, 2, 1}));
    const Shot without = shoot(renderer, snapshot);
    EXPECT_EQ(middle(without.color)[3], 0);
    scene::SnapshotMaterial mask = plain({9, 9, 9, 0.5F});
    mask.writes = scene::Writes::Alpha;
    add_wall(snapshot, 4, 1, mask);
    add_wall(snapshot, 20, 40, mask);  // hidden behind the wall, seen around it
    const Shot with = shoot(renderer, snapshot);
    for (std::uint32_t y = 0; y < small.height; ++y) {
        for (std::uint32_t x = 0; x < small.width; ++x) {
            const bool is_near = x >= 26 && x < 38 && y >= 18 && y < 30;
            const bool is_wall = x >= 14 && x < 50 && y >= 6 && y < 42;
            EXPECT_EQ(with.color.at(x, y)[3], is_near || !is_wall ? 0.5F : 0.0F) << x << ", " << y;
            for (std::size_t c = 0; c < 3; ++c) EXPECT_EQ(with.color.at(x, y)[c], without.color.at(x, y)[c]);
            EXPECT_EQ(with.depth.at(x, y)[0], without.depth.at(x, y)[0]);
        }
    }
}

TEST(RenderGpuMesh, BackFacesAreCulledUnlessDoubleSidedAndMirroredOnesTurnAround) {
    const scene::Assets assets = assets_of(triangle());
    const auto is_seen = [&](bool is_turned, bool is_double_sided) {
        scene::SnapshotMaterial material = plain({4, 4, 4, 1});
        material.surface.is_double_sided = is_double_sided;
        Renderer renderer = renderer_for({.extent = small}, assets);
        scene::Snapshot snapshot = snapshot_of_model(material);
        scene::Instance& instance = snapshot.instances[0];
        if (is_turned)
            instance.world =
                glm::translate(mat4(1), {0, 0, -8}) * glm::rotate(mat4(1), glm::pi<float>(), vec3(0, 1, 0));
        return middle(shoot(renderer, snapshot).color)[0] == 4;
    };
    EXPECT_TRUE(is_seen(false, false));
    EXPECT_FALSE(is_seen(true, false));
    EXPECT_TRUE(is_seen(true, true));
    Renderer renderer = renderer_for({.extent = small}, assets);
    scene::Snapshot snapshot = snapshot_of_model(plain({4, 4, 4, 1}));
    snapshot.instances[0].world = glm::scale(mat4(1), {-1, 1, 1});
    snapshot.instances[0].is_mirrored = true;
    const Shot shot = shoot(renderer, snapshot);
    EXPECT_EQ(middle(shot.color)[0], 4);
    EXPECT_NEAR(middle(shot.normals)[2], 1, 1e-3F) << "normals of mirrored instances still point outside";
}

TEST(RenderGpuMesh, NormalsOfStretchedInstancesStayUpright) {
    scene::Primitive slope;
    // In the plane x = z, whose normal is (-1, 0, 1) / sqrt 2.
    for (const vec3& position : {vec3(-1, -1, -1), vec3(1, -1, 1), vec3(0, 1, 0)})
        slope.vertices.push_back({.position = position, .normal = glm::normalize(vec3(-1, 0, 1))});
    slope.indices = {0, 1, 2};
    Renderer renderer = renderer_for({.extent = small}, assets_of(slope));
    scene::Snapshot snapshot = snapshot_of_model(plain(vec4(1)));
    snapshot.instances[0].world = glm::translate(mat4(1), {0, 0, -4}) * glm::scale(mat4(1), {2, 1, 1});
    const std::array<float, 4> normal = middle(shoot(renderer, snapshot).normals);
    // x / 2 = z now: normal (-1, 0, 2) / sqrt 5.
    expect_near(normal, {-0.4472F, 0, 0.8944F, normal[3]}, 2e-3F);
}

/// Pixels of the picture that are bright, as their box.
struct Extent {
    std::uint32_t left = ~0U, top = ~0U, right = 0, bottom = 0;
};
Extent bright_extent(const Pixels& pixels) {
    Extent out;
    for (std::uint32_t y = 0; y < pixels.height; ++y) {
        for (std::uint32_t x = 0; x < pixels.width; ++x) {
            if (pixels.at(x, y)[0] < 3) continue;
            out.left = std::min(out.left, x);
            out.right = std::max(out.right, x + 1);
            out.top = std::min(out.top, y);
            out.bottom = std::max(out.bottom, y + 1);
        }
    }
    return out;
}

/// The drawn triangle reaches as far as the CPU's own vertices do, to the pixel.
void expect_extent(const Pixels& pixels, const scene::CameraState& camera, const std::vector<vec3>& vertices) {
    vec2 low(1e9F), high(-1e9F);
    for (const vec3& vertex : vertices) {
        const vec4 clip = camera.projection * camera.view * vec4(vertex, 1);
        const vec2 pixel = (vec2(clip) / clip.w * 0.5F + 0.5F) * vec2(small.width, small.height);
        low = glm::min(low, pixel);
        high = glm::max(high, pixel);
    }
    const Extent found = bright_extent(pixels);
    EXPECT_NEAR(static_cast<float>(found.left), low.x, 1.5F);
    EXPECT_NEAR(static_cast<float>(found.right), high.x, 1.5F);
    // A sharp tip covers no pixel's centre in its last rows.
    EXPECT_NEAR(static_cast<float>(found.top), low.y, 2.5F);
    EXPECT_NEAR(static_cast<float>(found.bottom), high.y, 2.5F);
}

TEST(RenderGpuMesh, SkinnedVerticesAreWhereTheCpuPutsThem) {
    scene::Primitive primitive = triangle();
    for (std::uint16_t i = 0; i < 3; ++i)
        primitive.skin.push_back({.joints = {i, 3, 0, 0}, .weights = {0.75F, 0.25F, 0, 0}});
    Renderer renderer = renderer_for({.extent = small}, assets_of(primitive));
    scene::Snapshot snapshot = snapshot_of_model(plain({4, 4, 4, 1}));
    snapshot.joints = {mat4(9)};  // not this instance's
    const std::array moves{vec3(-1, 0.5F, 0), vec3(1, 0, -0.5F), vec3(0.5F, 1, 0.25F), vec3(-0.4F, 0, 0)};
    for (const vec3& move : moves) snapshot.joints.push_back(glm::translate(mat4(1), move));
    snapshot.previous_joints = snapshot.joints;
    const vec3 before(0.5F, 0.25F, 0);
    for (mat4& joint : snapshot.previous_joints) joint = glm::translate(mat4(1), before) * joint;
    scene::Instance& instance = snapshot.instances[0];
    instance.first_joint = 1;
    instance.joint_count = 4;
    instance.world = glm::translate(mat4(1), {50, 0, 0});  // skinned vertices ignore it
    const Shot shot = shoot(renderer, snapshot);
    const std::vector<vec3> truth = scene::deform(primitive, instance.world, std::span(snapshot.joints).subspan(1), {});
    expect_extent(shot.color, snapshot.camera, truth);
    const vec3 center = (truth[0] + truth[1] + truth[2]) / 3.0F;
    const auto place = [&](vec3 point) {
        const vec4 clip = snapshot.camera.projection * vec4(point, 1);
        return (vec2(clip) / clip.w * 0.5F + 0.5F) * vec2(small.width, small.height);
    };
    const vec2 pixel = place(center);
    const auto x = static_cast<std::uint32_t>(pixel.x), y = static_cast<std::uint32_t>(pixel.y);
    EXPECT_EQ(shot.color.at(x, y)[0], 4) << "above 1";
    const std::array<float, 4> motion = shot.velocity.at(x, y);
    EXPECT_NEAR(motion[0], place(center + before).x - pixel.x, 0.2F);
    EXPECT_NEAR(motion[1], place(center + before).y - pixel.y, 0.2F);
}

TEST(RenderGpuMesh, TransparentSkinnedMeshesAreTransparent) {
    scene::Primitive primitive = triangle();
    primitive.skin.resize(3);
    Renderer renderer = renderer_for({.extent = small}, assets_of(primitive));
    scene::SnapshotMaterial material = plain({4, 4, 4, 1}, SurfaceBlend::Alpha);
    material.opacity = 0.25F;
    scene::Snapshot snapshot = snapshot_of_model(material);
    snapshot.joints = snapshot.previous_joints = {mat4(1)};
    snapshot.instances[0].first_joint = 0;
    snapshot.instances[0].joint_count = 1;
    add_wall(snapshot, 8, 20, plain({0, 1, 0, 1}));
    expect_near(middle(shoot(renderer, snapshot).color), {1, 1.75F, 1, 1}, 4e-3F);
}

TEST(RenderGpuMesh, MorphedVerticesAreWhereTheCpuPutsThem) {
    scene::Primitive primitive = triangle();
    primitive.targets = {{.positions = {vec3(-1, 0, 0), vec3(1, 0, 0), vec3(0, 0.5F, 0)},
                          .normals = {vec3(1, 0, -1), vec3(1, 0, -1), vec3(1, 0, -1)}},
                         {.positions = {vec3(0, -1, 0), vec3(0, -0.5F, 0), vec3(0, 0, 0)}, .normals = {}}};
    Renderer renderer = renderer_for({.extent = small}, assets_of(primitive));
    scene::Snapshot snapshot = snapshot_of_model(plain({4, 4, 4, 1}));
    snapshot.weights = snapshot.previous_weights = {9, 0.5F, 1};
    snapshot.previous_weights[2] = 0;
    snapshot.instances[0].first_weight = 1;
    snapshot.instances[0].weight_count = 2;
    const Shot shot = shoot(renderer, snapshot);
    expect_extent(shot.color, snapshot.camera, scene::deform(primitive, mat4(1), {}, std::array{0.5F, 1.0F}));
    // (0, 0, 1) + 0.5 * (1, 0, -1), normalised.
    EXPECT_NEAR(middle(shot.normals)[0], 0.7071F, 2e-3F);
    EXPECT_LT(shot.velocity.at(24, 33)[1], -2) << "its lower left corner was above";
}

TEST(RenderGpuMesh, RoomsAreEdgesWithNothingBetween) {
    Renderer renderer = renderer_for({.extent = small});
    scene::Snapshot snapshot = snapshot_of(small);
    scene::Instance& room = add_wall(snapshot, 4, 3, plain({4, 4, 4, 1}, SurfaceBlend::Alpha));
    room.is_wireframe = true;
    const Shot shot = shoot(renderer, snapshot);
    EXPECT_LT(middle(shot.color)[0], 1);
    int bright = 0;
    for (std::uint32_t x = 16; x < 48; ++x) bright += shot.color.at(x, 6)[0] > 3 || shot.color.at(x, 5)[0] > 3 ? 1 : 0;
    EXPECT_EQ(bright, 32) << "its upper front edge";
    EXPECT_EQ(renderer.counters().draw_calls, 1U);
}

TEST(RenderGpuMesh, OverlaysDrawEdgesAndArrowsOverThePicture) {
    if (!gpu::test::context().traits.has_wireframe) GTEST_SKIP() << "the device draws no edges of triangles";
    scene::Snapshot snapshot = snapshot_of(small);
    add_wall(snapshot, 4, 3, plain({0, 0, 0, 1}));
    const auto lit_pixels = [&](const RenderDesc& desc) {
        Renderer renderer = renderer_for(desc);
        const Shot shot = shoot(renderer, snapshot);
        int lit = 0;
        for (std::uint32_t y = 10; y < 38; ++y)
            for (std::uint32_t x = 18; x < 46; ++x) lit += shot.color.at(x, y)[0] > 0.3F ? 1 : 0;
        return lit;
    };
    EXPECT_EQ(lit_pixels({.extent = small}), 0);
    const int diagonal = lit_pixels({.extent = small, .draw = {.has_wireframe_overlay = true}});
    EXPECT_GE(diagonal, 25);
    EXPECT_LE(diagonal, 60);
    add_box(snapshot, {0, 0, -4}, {0.5F, 0.5F, -3.5F}, plain({0, 0, 0, 1}));
    EXPECT_GT(lit_pixels({.extent = small, .draw = {.has_normal_arrows = true}}), 0);
}

TEST(RenderGpuMesh, TheViewOfEdgesShowsNoSurface) {
    if (!gpu::test::context().traits.has_wireframe) GTEST_SKIP() << "the device draws no edges of triangles";
    Renderer renderer =
        renderer_for({.extent = small, .output = Output::Display, .draw = {.debug = DebugView::Wireframe}});
    scene::Snapshot snapshot = snapshot_of(small);
    add_wall(snapshot, 4, 3, plain({1, 1, 1, 1}));
    const Pixels picture = shoot(renderer, snapshot).color;
    int lit = 0;
    for (std::uint32_t y = 8; y < 40; ++y)
        for (std::uint32_t x = 18; x < 46; ++x) lit += picture.at(x, y)[0] > 0.5F ? 1 : 0;
    EXPECT_GT(lit, 20);
    EXPECT_LT(lit, 200);
    // What is black is seen, too.
    snapshot = snapshot_of(small);
    add_wall(snapshot, 4, 3, plain({0, 0, 0, 1}));
    const Pixels black = shoot(renderer, snapshot).color;
    lit = 0;
    for (std::uint32_t y = 8; y < 40; ++y)
        for (std::uint32_t x = 18; x < 46; ++x) lit += black.at(x, y)[0] > 0.3F ? 1 : 0;
    EXPECT_GT(lit, 20);
}

TEST(RenderGpuMesh, TexturesAreDecodedByTheirUse) {
    scene::Assets assets;
    assets.images.push_back({.name = "grey", .width = 3, .height = 2, .rgba = {}});
    for (int i = 0; i < 6; ++i) assets.images[0].rgba.insert(assets.images[0].rgba.end(), {188, 188, 188, 255});
    Renderer renderer = renderer_for({.extent = small}, assets);
    scene::Snapshot snapshot = snapshot_of(small);
    scene::SnapshotMaterial material = plain({1, 2, 1, 1});
    material.entity_texture = 0;
    add_wall(snapshot, 4, 3, material);
    // 188 is half of the light.
    expect_near(middle(shoot(renderer, snapshot).color), {0.503F, 1.006F, 0.503F, 1}, 4e-3F);
}

// What lies between two codes of 8 bits differs on the screen, and light above 1 stays.
TEST(RenderGpuMesh, WideTexturesKeepTheirNumbers) {
    const auto shown = [](scene::ImageKind kind, std::uint16_t sample) {
        scene::Assets assets;
        assets.images.push_back({.name = "wide", .width = 2, .height = 2, .wide = {}, .kind = kind});
        const std::uint16_t alpha = kind == scene::ImageKind::Halves ? glm::packHalf1x16(1) : 0xffff;
        for (int i = 0; i < 4; ++i)
            assets.images[0].wide.insert(assets.images[0].wide.end(), {sample, sample, sample, alpha});
        Renderer renderer = renderer_for({.extent = small}, assets);
        scene::Snapshot snapshot = snapshot_of(small);
        scene::SnapshotMaterial material = plain({1, 1, 1, 1});
        material.entity_texture = 0;
        add_wall(snapshot, 4, 3, material);
        return middle(shoot(renderer, snapshot).color)[0];
    };
    float before = 0;
    for (std::uint16_t code = 188 * 257; code <= 189 * 257; code = static_cast<std::uint16_t>(code + 64)) {
        const float value = shown(scene::ImageKind::Codes16, code);
        EXPECT_GT(value, before) << code;
        EXPECT_NEAR(value, std::pow((static_cast<float>(code) / 65535 + 0.055F) / 1.055F, 2.4F), 1e-3F) << code;
        before = value;
    }
    EXPECT_EQ(shown(scene::ImageKind::Halves, glm::packHalf1x16(12)), 12);
}

// A square of 256 texels, of leaves or of what is left between them, from 256 pixels down to 16.
TEST(RenderGpuMesh, WhatIsCutOutKeepsItsShareAtEveryDistance) {
    constexpr std::uint32_t side = 256;
    for (const bool is_hedge : {false, true}) {
        std::vector<float> alphas(side * side, 0.0F);
        std::uint32_t random = 1;
        for (int leaf = 0; leaf < 330; ++leaf) {
            const auto next = [&] { return static_cast<float>((random = random * 1664525U + 1013904223U) >> 8U); };
            const float center_x = next() / 65536, center_y = next() / 65536, turn = next() / 65536;
            for (int i = -12; i <= 12; ++i)
                for (int j = -12; j <= 12; ++j) {
                    const auto x = static_cast<float>(j), y = static_cast<float>(i);
                    const float along = x * std::cos(turn) + y * std::sin(turn);
                    const float across = y * std::cos(turn) - x * std::sin(turn);
                    const std::uint32_t column = static_cast<std::uint32_t>(center_x + x + side) % side;
                    float& alpha = alphas[static_cast<std::uint32_t>(center_y + y + side) % side * side + column];
                    alpha = std::max(alpha, 1.75F - 1.5F * std::hypot(along / 8, across / 2.2F));
                }
        }
        scene::Image image{.name = "leaves", .width = side, .height = side, .rgba = {}};
        float share = 0;
        for (const float alpha : alphas) {
            const auto code = static_cast<std::uint8_t>(std::clamp(is_hedge ? 1 - alpha : alpha, 0.0F, 1.0F) * 255);
            image.rgba.insert(image.rgba.end(), {255, 255, 255, code});
            share += code >= 128 ? 1.0F / (side * side) : 0;
        }
        scene::Primitive square;
        for (const vec2& corner : {vec2(0, 1), vec2(1, 1), vec2(1, 0), vec2(0, 0)})
            square.vertices.push_back({.position = vec3(corner.x - 0.5F, 0.5F - corner.y, -4), .uv0 = corner});
        square.indices = {0, 1, 2, 0, 2, 3};
        scene::Assets assets = assets_of(square);
        assets.models[0].images = {image};
        // A factor takes alpha down, and the cutoff with it.
        scene::SnapshotMaterial material = plain({1, 1, 1, 0.6F}, SurfaceBlend::Mask);
        material.surface.alpha_cutoff = 0.3F;
        material.surface.base_color_texture.image = 0;
        material.model = 0;
        assets.models[0].materials = {material.surface};
        Renderer renderer = renderer_for({.extent = {side, side}}, assets, dark_scene());
        for (const float pixels : {256.0F, 64.0F, 32.0F, 16.0F}) {
            scene::Snapshot snapshot = snapshot_of_model(material);
            snapshot.camera = front_camera({side, side}, 1);
            const float size = pixels / side, off = 0.37F / side;
            snapshot.instances[0].world = glm::scale(glm::translate(mat4(1), {off, off, 0}), {size, size, 1});
            snapshot.instances[0].previous_world = snapshot.instances[0].world;
            const Pixels color = shoot(renderer, snapshot).color;
            float lit = 0;
            for (std::size_t i = 0; i < color.rgba.size(); i += 4) lit += color.rgba[i];
            EXPECT_NEAR(lit / (pixels * pixels) / share, 1, 0.2F)
                << pixels << (is_hedge ? " of a hedge" : " of leaves");
        }
    }
}

TEST(RenderGpuMesh, VertexColoursKeepWhatEightBitsDoNotHold) {
    scene::Primitive primitive = triangle();
    for (scene::Vertex& vertex : primitive.vertices) vertex.color = vec4(0.0019F, 1 / 65535.0F, 0.5001F, 1);
    Renderer renderer = renderer_for({.extent = small}, assets_of(primitive));
    const std::array<float, 4> found = middle(shoot(renderer, snapshot_of_model(plain(vec4(1)))).color);
    EXPECT_NEAR(found[0] / 0.0019F, 1, 1e-3F);  // as halves have it
    EXPECT_NEAR(found[1] * 65535, 1, 1e-2F);
}

TEST(RenderGpuMesh, TexturesKeepTheirLevelAtTheEdgesOfTriangles) {
    // Half white, half black: every smaller level is grey. The mesh shows a piece of the white half, much enlarged.
    scene::Assets assets;
    assets.images.push_back({.name = "halves", .width = 64, .height = 64, .rgba = {}});
    for (int i = 0; i < 64 * 64; ++i) {
        const std::uint8_t value = i % 64 < 32 ? 255 : 0;
        assets.images[0].rgba.insert(assets.images[0].rgba.end(), {value, value, value, 255});
    }
    assets.models.resize(1);
    scene::Primitive fan{.vertices = {{.position = vec3(0, 0, -4), .uv0 = vec2(0.25F)}}, .indices = {}};
    for (std::uint32_t i = 0; i <= 32; ++i) {
        const float angle = glm::two_pi<float>() * static_cast<float>(i) / 32;
        const vec2 side(std::cos(angle), std::sin(angle));
        fan.vertices.push_back({.position = vec3(side * 3.0F, -4), .uv0 = 0.25F + side * 0.02F});
        if (i > 0) fan.indices.insert(fan.indices.end(), {0, i, i + 1});
    }
    assets.models[0].meshes.push_back({.primitives = {fan}});
    scene::SnapshotMaterial material = plain(vec4(1));
    material.entity_texture = 0;
    Renderer renderer = renderer_for({.extent = small}, assets);
    const Pixels color = shoot(renderer, snapshot_of_model(material)).color;
    for (std::uint32_t y = 12; y < 36; ++y)
        for (std::uint32_t x = 22; x < 42; ++x) EXPECT_EQ(color.at(x, y)[0], 1) << x << ", " << y;
}

}  // namespace
}  // namespace darkroom::render
