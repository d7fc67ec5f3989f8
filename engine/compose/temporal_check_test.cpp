// SPDX-License-Identifier: MIT
// Hosts that are right, of every convention, and hosts with one mistake each.

#include <gtest/gtest.h>
#include <array>
#include <cmath>
#include <darkroom/composer.hpp>
#include <darkroom/temporal_check.hpp>
#include <functional>

namespace darkroom {
namespace {

constexpr VkExtent2D extent{32, 20};

/// y down, depth 0 near and 1 far, or the other way around.
Matrix projection_of(bool is_reversed, bool is_y_down) {
    constexpr float near = 0.1F, far = 100;
    const float a = is_reversed ? near / (far - near) : far / (near - far);
    const float b = is_reversed ? near * far / (far - near) : near * far / (near - far);
    return {1, 0, 0, 0, 0, is_y_down ? -1.6F : 1.6F, 0, 0, 0, 0, a, -1, 0, 0, b, 0};
}

/// A step to the side and forward, and a turn about the axis of view.
Matrix moved_view() {
    const float c = std::cos(0.02F), s = std::sin(0.02F);
    return {c, s, 0, 0, -s, c, 0, 0, 0, 0, 1, 0, 0.4F, -0.25F, 0.5F, 1};
}

struct HostDesc {
    DepthKind depth = DepthKind::Standard;
    VelocityKind velocity;
    bool is_y_down = true;
    bool moves = true;
};

/// A frame of a host that does everything right: a floor that goes away, in numbers of its own.
struct GatheredHost {
    explicit GatheredHost(const HostDesc& desc) {
        const bool is_reversed = desc.depth == DepthKind::Reversed;
        const Matrix lens = projection_of(is_reversed, desc.is_y_down);
        camera.jitter = Composer::jitter(4, 1.5F);
        camera.previous_jitter = Composer::jitter(3, 1.5F);
        camera.projection = jittered(lens, camera.jitter, extent, desc.is_y_down);
        camera.previous_projection = jittered(lens, camera.previous_jitter, extent, desc.is_y_down);
        if (desc.moves) camera.previous_view = moved_view();
        camera.far_distance = 100;
        camera.depth = desc.depth;
        camera.velocity = desc.velocity;
        camera.is_y_down = desc.is_y_down;
        for (std::uint32_t y = 0; y < extent.height; ++y)
            for (std::uint32_t x = 0; x < extent.width; ++x) add_pixel(lens, x, y, desc);
    }
    [[nodiscard]] std::vector<std::string> mistakes() const {
        return check_temporal({.camera = camera, .extent = extent, .depth = depth, .velocity = velocity});
    }
    /// The only mistake begins so.
    void expect_mistake(const std::string& start) const {
        const std::vector<std::string> found = mistakes();
        ASSERT_EQ(found.size(), 1U) << start;
        EXPECT_TRUE(found[0].starts_with(start)) << found[0];
    }

    Camera camera;
    std::vector<float> depth, velocity;

  private:
    void add_pixel(const Matrix& lens, std::uint32_t x, std::uint32_t y, const HostDesc& desc) {
        const float down = desc.is_y_down ? 1.0F : -1.0F;
        // Without jitter the centre sees what lies beside it.
        const float px = static_cast<float>(x) + 0.5F - camera.jitter[0],
                    py = static_cast<float>(y) + 0.5F - camera.jitter[1];
        const float distance = 4 + 0.8F * static_cast<float>(extent.height - y);
        const float at_x = (px / extent.width * 2 - 1) * distance / lens[0],
                    at_y = (py / extent.height * 2 - 1) * down * distance / lens[5];
        depth.push_back(desc.depth == DepthKind::Planar ? distance : (lens[10] * -distance + lens[14]) / distance);
        const Matrix& view = camera.previous_view;
        std::array<float, 3> was{};
        for (std::size_t row = 0; row < 3; ++row)
            was[row] = view[row] * at_x + view[4 + row] * at_y + view[8 + row] * -distance + view[12 + row];
        const float was_px = (was[0] * lens[0] / -was[2] + 1) / 2 * extent.width,
                    was_py = (was[1] * lens[5] / -was[2] * down + 1) / 2 * extent.height;
        std::array<float, 2> motion{was_px - px, was_py - py};
        for (std::size_t axis = 0; axis < 2; ++axis) {
            if (desc.velocity.has_jitter) motion[axis] += camera.previous_jitter[axis] - camera.jitter[axis];
            const auto size = static_cast<float>(axis == 0 ? extent.width : extent.height);
            if (desc.velocity.unit == VelocityKind::Unit::Uv) motion[axis] /= size;
            if (desc.velocity.unit == VelocityKind::Unit::Ndc) motion[axis] /= size / 2;
            if (desc.velocity.sign == VelocityKind::Sign::CurrentMinusPrevious) motion[axis] *= -1;
            if (axis == 1 && !desc.velocity.is_y_down) motion[axis] *= -1;
            velocity.push_back(motion[axis]);
        }
    }
};

void for_each_host(const std::function<void(const HostDesc&)>& call) {
    for (const DepthKind depth : {DepthKind::Standard, DepthKind::Reversed, DepthKind::Planar})
        for (const auto sign : {VelocityKind::Sign::PreviousMinusCurrent, VelocityKind::Sign::CurrentMinusPrevious})
            for (const auto unit : {VelocityKind::Unit::Pixels, VelocityKind::Unit::Uv, VelocityKind::Unit::Ndc})
                for (int bits = 0; bits < 16; ++bits)
                    call({.depth = depth,
                          .velocity = {sign, unit, (bits & 1) != 0, (bits & 2) != 0},
                          .is_y_down = (bits & 4) != 0,
                          .moves = (bits & 8) != 0});
}

TEST(TemporalCheck, HostsOfEveryConventionAreRight) {
    for_each_host([](const HostDesc& desc) {
        const std::vector<std::string> found = GatheredHost(desc).mistakes();
        EXPECT_TRUE(found.empty()) << found[0];
    });
}

// The first of the three: also where the camera stands still, and where nobody gives depth.
TEST(TemporalCheck, JitterInVectorsIsSaid) {
    for_each_host([](const HostDesc& desc) {
        GatheredHost host(desc);
        host.camera.velocity.has_jitter = !desc.velocity.has_jitter;
        host.expect_mistake(desc.velocity.has_jitter
                                ? "velocity: holds the jitter, which camera.velocity.has_jitter does not say"
                                : "velocity: holds no jitter, and camera.velocity.has_jitter says");
        if (desc.moves) return;
        host.depth.clear();
        EXPECT_EQ(host.mistakes().size(), 1U);
    });
}

// The second: of the vectors, of one of their axes, and of the jitter that is told.
TEST(TemporalCheck, SignsAreSaid) {
    for_each_host([](const HostDesc& desc) {
        if (!desc.moves) return;
        GatheredHost turned(desc);
        turned.camera.velocity.sign = static_cast<VelocityKind::Sign>(1 - static_cast<int>(desc.velocity.sign));
        // Jitter that is in the vectors has then the wrong sign as well.
        if (!desc.velocity.has_jitter) turned.expect_mistake("velocity: has the other sign than");
        GatheredHost upside_down(desc);
        upside_down.camera.velocity.is_y_down = !desc.velocity.is_y_down;
        if (!desc.velocity.has_jitter) upside_down.expect_mistake("velocity: has y the other way than");
    });
    GatheredHost host({.moves = false});
    for (std::array<float, 2>* const jitter : {&host.camera.jitter, &host.camera.previous_jitter})
        *jitter = {-(*jitter)[0], -(*jitter)[1]};
    const std::vector<std::string> found = host.mistakes();
    ASSERT_GE(found.size(), 2U);
    EXPECT_TRUE(found[0].starts_with("camera.jitter: has the wrong sign in x")) << found[0];
    EXPECT_TRUE(found[1].starts_with("camera.jitter: has the wrong sign in y")) << found[1];
}

// The third.
TEST(TemporalCheck, TheDirectionOfDepthIsSaid) {
    for (const bool is_reversed : {false, true}) {
        GatheredHost host({.depth = is_reversed ? DepthKind::Reversed : DepthKind::Standard, .moves = false});
        host.camera.depth = is_reversed ? DepthKind::Standard : DepthKind::Reversed;
        host.expect_mistake(is_reversed ? "camera.depth: Standard is told, and the projection makes depth smaller"
                                        : "camera.depth: Reversed is told, and the projection makes depth larger");
    }
}

TEST(TemporalCheck, UnitsAndMissingJitterAndSizesAreSaid) {
    GatheredHost pixels({.velocity = {.unit = VelocityKind::Unit::Uv}});
    pixels.camera.velocity.unit = VelocityKind::Unit::Pixels;
    const std::vector<std::string> found = pixels.mistakes();
    ASSERT_FALSE(found.empty());
    EXPECT_NE(found[0].find("camera.velocity.unit"), std::string::npos) << found[0];
    GatheredHost still({.moves = false});
    still.camera.projection = still.camera.previous_projection = projection_of(false, true);
    EXPECT_TRUE(still.mistakes().at(0).starts_with("camera.projection: has no jitter; camera.jitter tells of"));
    GatheredHost small({});
    small.velocity.pop_back();
    small.expect_mistake("velocity: 1279 numbers, 32x20 pixels have 1280");
}

// A third of the picture that moves by itself hides no mistake and makes none.
TEST(TemporalCheck, WhatMovesByItselfDoesNoHarm) {
    for (const bool is_told : {false, true}) {
        GatheredHost host({.velocity = {.has_jitter = true}});
        for (std::size_t i = 0; i < host.velocity.size() / 3; ++i) host.velocity[i] += 7;
        host.camera.velocity.has_jitter = is_told;
        EXPECT_EQ(host.mistakes().size(), is_told ? 0U : 1U);
    }
}

}  // namespace
}  // namespace darkroom
