// SPDX-License-Identifier: MIT
// The table of docs/limits.md that says what a moment of a scene takes, figure by figure: scenes that fill the budget
// to its last byte are drawn, and one particle more is refused.
#include <gtest/gtest.h>

#include "scene/pose/snapshot.hpp"

namespace darkroom::scene {
namespace {

constexpr std::uint64_t particle = 256, emitter_work = 512 << 10, kibi = 1024;

/// A scene, and what the page says that it takes.
struct Filled {
    Scene scene;
    Assets assets;
    std::uint64_t bytes = 0, work = 0;

    Entity& add(std::uint32_t model = no_index) {
        scene.entities.emplace_back();
        assets.entities.push_back({.model = model});
        return scene.entities.back();
    }
    void add_emitter(std::uint64_t particles) {
        add().emitter = ParticleEmitter{.max_particles = static_cast<std::uint32_t>(particles)};
        bytes += particles * particle;
        work += emitter_work;
    }
    Model& add_model(std::uint64_t nodes) {
        Model& model = assets.models.emplace_back();
        model.nodes.resize(nodes);
        add(static_cast<std::uint32_t>(assets.models.size() - 1));
        bytes += nodes * 256;
        return model;
    }
    [[nodiscard]] std::string refusal() const {
        const Result<> checked = check_snapshot(scene, assets);
        return checked ? "" : checked.error().text;
    }
};

void expect_exact(Filled filled, const std::string& row) {
    ASSERT_EQ(filled.bytes % particle, 0U) << row;
    ASSERT_LT(filled.bytes, Budget::free_bytes) << row;
    while (Budget::free_bytes - filled.bytes > 10000 * particle) filled.add_emitter(10000);
    Filled over = filled;
    filled.add_emitter((Budget::free_bytes - filled.bytes) / particle);
    EXPECT_EQ(filled.refusal(), "") << row;
    over.add_emitter((Budget::free_bytes - over.bytes) / particle + 1);
    EXPECT_NE(over.refusal().find(" particles of 256 bytes"), std::string::npos) << row << ": " << over.refusal();
}

void expect_exact_work(Filled filled, const std::string& row) {
    // What is kept has been gone through, too.
    const auto left = [&] { return Budget::free_work - filled.bytes - filled.work; };
    ASSERT_LT(filled.bytes + filled.work, Budget::free_work) << row;
    ASSERT_EQ(left() % particle, 0U) << row;
    while (left() >= 2 * emitter_work) filled.add_emitter(0);
    Filled over = filled;
    filled.add_emitter((left() - emitter_work) / particle);
    EXPECT_EQ(filled.refusal(), "") << row;
    over.add_emitter((Budget::free_work - over.bytes - over.work - emitter_work) / particle + 1);
    EXPECT_NE(over.refusal(), "") << row;
}

TEST(SceneSnapshotBudget, BytesAreThoseOfThePage) {
    expect_exact({}, "particle");
    Filled lights, sprites, boxes;
    for (std::uint64_t i = 0; i < kibi; ++i) {
        lights.add().light = Light{};
        sprites.add().sprite = Sprite{};
        boxes.add().bounds = Box{};
    }
    lights.bytes = sprites.bytes = kibi * 256;
    boxes.bytes = kibi * 1536;
    expect_exact(std::move(lights), "light");
    expect_exact(std::move(sprites), "sprite");
    expect_exact(std::move(boxes), "instance: a box with its material");

    Filled nodes;
    nodes.add_model(kibi);
    Filled again = nodes;
    again.add(0);  // the same pose, which is there
    again.work = kibi * 256;
    expect_exact(std::move(nodes), "node");
    expect_exact(std::move(again), "node of the same animation and speed");

    Filled models;
    Model& model = models.add_model(1);
    model.meshes.resize(1);
    model.meshes[0].primitives.resize(kibi);
    model.materials.resize(255);
    model.nodes[0].mesh = 0;
    models.bytes += kibi * 1024 + 256 * 512;
    expect_exact(std::move(models), "instance: a primitive of a node; material of a model");

    Filled skins;
    Model& figure = skins.add_model(2);
    figure.meshes.resize(1);
    figure.skins.resize(1);
    figure.skins[0].joints.resize(kibi);
    figure.nodes[0].mesh = figure.nodes[1].mesh = 0;
    figure.nodes[0].skin = figure.nodes[1].skin = 0;
    skins.bytes += kibi * 128 + 2 * kibi * 384;
    expect_exact(std::move(skins), "joint of a skin; joint of a skin, for each node that has it");

    Filled morphs;
    Model& face = morphs.add_model(1);
    face.meshes.resize(1);
    face.meshes[0].weights.resize(kibi);
    face.nodes[0].mesh = 0;
    morphs.bytes += kibi * 32;
    expect_exact(std::move(morphs), "weight of a morph target");
}

TEST(SceneSnapshotBudget, WorkIsThatOfThePage) {
    expect_exact_work({}, "emitter");
    Filled parents;
    for (std::uint32_t i = 0; i < 256; ++i) parents.add().parent = i == 0 ? Entity::none : i - 1;
    parents.add_emitter(kibi);
    parents.scene.entities.back().parent = 255;
    parents.work += kibi * 256 * 8;
    expect_exact_work(std::move(parents), "parent, for each particle below it");

    const auto with_mesh = [](Primitive primitive) {
        Filled filled;
        Model& model = filled.add_model(1);
        model.meshes.resize(1);
        model.meshes[0].primitives.push_back(std::move(primitive));
        model.nodes[0].mesh = 0;
        filled.bytes += 1024 + 512;
        return filled;
    };
    Primitive triangles;
    triangles.indices.resize(std::size_t{3} * 256 * kibi);
    Filled surface = with_mesh(std::move(triangles));
    surface.work = 256 * kibi * 4;
    expect_exact_work(std::move(surface), "triangle");

    Primitive morphed;
    morphed.vertices.resize(16 * kibi);
    morphed.targets.resize(8);
    Filled face = with_mesh(std::move(morphed));
    face.bytes += std::uint64_t{8} * 32;
    face.work = 16 * kibi * 9 * 32;
    expect_exact_work(std::move(face), "vertex with morph targets, times their number and one");

    Primitive skinned;
    skinned.vertices.resize(16 * kibi);
    skinned.skin.resize(16 * kibi);
    Filled figure = with_mesh(std::move(skinned));
    figure.assets.models[0].skins.resize(1);
    figure.assets.models[0].nodes[0].skin = 0;
    figure.work = 16 * kibi * 32;
    expect_exact_work(std::move(figure), "vertex of a skin");
}

}  // namespace
}  // namespace darkroom::scene
