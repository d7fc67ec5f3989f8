// SPDX-License-Identifier: MIT
#include "image/frame/frame_file.hpp"

#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/primaries.hpp"
#include "image/exr/test_exr.hpp"
#include "image/picture/write.hpp"
#include "image/test_files.hpp"

namespace darkroom {
namespace {

class ImageFrame : public WithFolder {};
class ImageFrameData : public WithData {};

FrameFile full_frame() {
    FrameFile frame;
    frame.color = Picture(5, 3);
    frame.depth = Plane<1>(5, 3);
    frame.normals = Plane<3>(5, 3);
    frame.velocity = Plane<2>(5, 3);
    frame.reactive = Plane<1>(5, 3);
    frame.transparency = Plane<3>(5, 3);
    for (std::size_t i = 0; i < 15; ++i) frame.reactive->values[i] = static_cast<float>(i) / 16;
    for (std::size_t i = 0; i < 45; ++i) frame.transparency->values[i] = static_cast<float>(i) / 4;
    frame.exposure = 1.0F / 3;
    frame.has_alpha = true;
    for (std::size_t i = 0; i < frame.color.pixels.size(); ++i) frame.color.pixels[i] = static_cast<float>(i) / 8;
    for (std::size_t i = 0; i < 15; ++i) frame.depth->values[i] = 1.0f + static_cast<float>(i) / 3;
    frame.depth->values[7] = sky_depth;
    for (std::size_t i = 0; i < 45; ++i) frame.normals->values[i] = static_cast<float>(i % 5) / 4 - 0.5f;
    for (std::size_t i = 0; i < 30; ++i) frame.velocity->values[i] = static_cast<float>(i) / 7 - 2;
    Matrix matrix{};
    // All sixteen differ, and the matrix has an inverse.
    for (std::size_t i = 0; i < 16; ++i) matrix[i] = static_cast<float>(i) + (i % 5 == 0 ? 20.25f : 0.25f);
    frame.camera.world_to_camera = matrix;
    matrix[3] = -7;
    frame.camera.projection = matrix;
    matrix[0] = 1.0F / 3;
    frame.camera.previous_world_to_camera = matrix;
    matrix[15] = 1e-30F;
    frame.camera.previous_projection = matrix;
    frame.camera.jitter = {1.0F / 3, -0.25F};
    frame.camera.previous_jitter = {-0.125F, 1e-3F};
    frame.camera.near_distance = 0.1F;
    frame.camera.far_distance = std::numeric_limits<float>::infinity();
    frame.time = 1.0 / 3;
    frame.delta_time = 1.0 / 24;
    frame.frame_index = 5'000'000'000;
    return frame;
}

TEST_F(ImageFrame, WhatIsWrittenIsRead) {
    const FrameFile frame = full_frame();
    ASSERT_TRUE(write_frame(file("a.exr"), frame));
    const auto back = read_frame(file("a.exr"));
    ASSERT_TRUE(back) << back.error().text;
    EXPECT_TRUE(back->color == frame.color);
    EXPECT_EQ(back->depth, frame.depth);
    EXPECT_EQ(back->normals, frame.normals);
    EXPECT_EQ(back->velocity, frame.velocity);
    EXPECT_EQ(back->reactive, frame.reactive);
    EXPECT_EQ(back->transparency, frame.transparency);
    EXPECT_EQ(back->exposure, frame.exposure);
    EXPECT_EQ(back->camera.world_to_camera, frame.camera.world_to_camera);
    EXPECT_EQ(back->camera.projection, frame.camera.projection);
    EXPECT_EQ(back->camera.previous_world_to_camera, frame.camera.previous_world_to_camera);
    EXPECT_EQ(back->camera.previous_projection, frame.camera.previous_projection);
    EXPECT_EQ(back->camera.jitter, frame.camera.jitter);
    EXPECT_EQ(back->camera.previous_jitter, frame.camera.previous_jitter);
    EXPECT_EQ(back->camera.near_distance, frame.camera.near_distance);
    EXPECT_EQ(back->camera.far_distance, frame.camera.far_distance);
    EXPECT_EQ(back->time, frame.time);
    EXPECT_EQ(back->delta_time, frame.delta_time);
    EXPECT_EQ(back->frame_index, frame.frame_index);
    EXPECT_TRUE(back->warnings.empty());
    EXPECT_FALSE(write_frame(file("a.png"), frame));
}

TEST_F(ImageFrame, WhatIsNotGivenStaysUnknown) {
    FrameFile frame = full_frame();
    frame.camera = {.world_to_camera = frame.camera.world_to_camera};
    frame.time = frame.delta_time = std::nullopt;
    frame.frame_index = std::nullopt;
    ASSERT_TRUE(write_frame(file("a.exr"), frame));
    const auto back = read_frame(file("a.exr"));
    ASSERT_TRUE(back) << back.error().text;
    EXPECT_TRUE(back->camera.world_to_camera);
    EXPECT_FALSE(back->camera.previous_world_to_camera || back->camera.previous_projection);
    EXPECT_FALSE(back->camera.jitter || back->camera.previous_jitter);
    EXPECT_FALSE(back->camera.near_distance || back->camera.far_distance);
    EXPECT_FALSE(back->time || back->delta_time || back->frame_index);
}

TEST_F(ImageFrame, AnotherCameraHasNoPast) {
    ASSERT_TRUE(write_frame(file("a.exr"), full_frame()));
    const auto wide = read_frame(file("a.exr"), {.vertical_field_of_view = 90});
    ASSERT_TRUE(wide) << wide.error().text;
    EXPECT_FALSE(wide->camera.previous_projection || wide->camera.far_distance || wide->camera.jitter);
    EXPECT_TRUE(wide->time);
}

TEST_F(ImageFrame, SignsOfZeroAreKept) {
    FrameFile frame = full_frame();
    frame.color.pixels[0] = -0.0F;
    ASSERT_TRUE(write_frame(file("a.exr"), frame));
    const auto back = read_frame(file("a.exr"));
    ASSERT_TRUE(back) << back.error().text;
    EXPECT_TRUE(std::signbit(back->color.pixels[0]));
}

TEST_F(ImageFrame, MappingGoesBeforeTheKnownNames) {
    ASSERT_TRUE(write_frame(file("a.exr"), full_frame()));
    FrameOptions options;
    ASSERT_TRUE(add_mapping(options.names, "depth=G"));
    ASSERT_TRUE(add_mapping(options.names, "color=N"));
    const auto back = read_frame(file("a.exr"), options);
    ASSERT_TRUE(back) << back.error().text;
    EXPECT_EQ(back->depth->values[1], 5.0f / 8);
    EXPECT_EQ(back->color.pixels[1], full_frame().normals->values[1]);
    EXPECT_EQ(back->warnings.size(), 0u) << "chromaticities are in the file";
}

TEST_F(ImageFrame, UnknownNameGivesTheNearest) {
    ASSERT_TRUE(write_frame(file("a.exr"), full_frame()));
    FrameOptions options;
    ASSERT_TRUE(add_mapping(options.names, "velocity=velocty"));
    const auto back = read_frame(file("a.exr"), options);
    ASSERT_FALSE(back);
    EXPECT_TRUE(back.error().text.starts_with(file("a.exr").string() +
                                              ": has no channels \"velocty\" for velocity, did you mean 'velocity'?"))
        << back.error().text;
    EXPECT_FALSE(add_mapping(options.names, "depht=Z"));
    EXPECT_FALSE(add_mapping(options.names, "depth"));
    EXPECT_FALSE(add_mapping(options.names, "depth="));
}

// What `info` calls what it found is asked for; where it found nothing, that is no reason to go on without.
TEST_F(ImageFrame, AMappingToALayerThatIsNotThereIsRefused) {
    test::store_floats(file("a.exr"), {"R", "G", "B"}, 1, std::vector<float>{1, 2, 3});
    for (const std::string what : {"depth", "normals", "velocity"}) {
        FrameOptions options;
        ASSERT_TRUE(add_mapping(options.names, what + "=" + what));
        const Result<FrameFile> frame = read_frame(file("a.exr"), options);
        ASSERT_FALSE(frame) << what;
        EXPECT_NE(frame.error().text.find("has no channels \"" + what + "\" for " + what), std::string::npos)
            << frame.error().text;
    }
    FrameOptions options;
    ASSERT_TRUE(add_mapping(options.names, "color=color"));
    EXPECT_TRUE(read_frame(file("a.exr"), options));
}

TEST_F(ImageFrame, PlainGrayGoesBeforeLayersOfOtherNames) {
    test::store_floats(file("a.exr"), {"Y", "light.R", "light.G", "light.B"}, 1, std::vector<float>{0.9F, 1, 2, 3});
    const Result<FrameFile> frame = read_frame(file("a.exr"));
    ASSERT_TRUE(frame) << frame.error().text;
    EXPECT_EQ(std::vector(frame->color.pixels.begin(), frame->color.pixels.begin() + 3),
              (std::vector<float>{0.9F, 0.9F, 0.9F}));
    ASSERT_EQ(frame->warnings.size(), 1U);
    EXPECT_NE(frame->warnings[0].find("the color is Y, although light might be it as well"), std::string::npos)
        << frame->warnings[0];
    test::store_floats(file("b.exr"), {"Y", "beauty.R", "beauty.G", "beauty.B"}, 1, std::vector<float>{0.9F, 1, 2, 3});
    EXPECT_EQ(read_frame(file("b.exr"))->color.pixels[0], 1) << "a name that says so goes before";
    test::store_floats(file("c.exr"), {"X", "Y", "Z", "light.R", "light.G", "light.B"}, 1,
                       std::vector<float>{0.9F, 0.9F, 0.9F, 1, 2, 3});
    EXPECT_EQ(read_frame(file("c.exr"))->color.pixels[0], 1) << "Y beside X is none";
}

/// Two pixels of colour, and of a layer.
FrameFile stored(const std::filesystem::path& path, const std::string& layer, std::array<float, 2> values,
                 const FrameOptions& options = {}, const std::function<void(Imf::Header&)>& change = {}) {
    const std::vector<float> all{0.1F, 0.2F, 0.3F, values[0], 0.4F, 0.5F, 0.6F, values[1]};
    test::store_floats(path, {"R", "G", "B", layer}, 2, all, change);
    Result<FrameFile> frame = read_frame(path, options);
    EXPECT_TRUE(frame) << frame.error().text;
    return frame ? std::move(*frame) : FrameFile{};
}

TEST_F(ImageFrame, DepthIsFoundByTheNamesOfRenderers) {
    for (const char* const name : {"Z", "depth", "depth.Z", "Depth.V", "hitPz", "Pz", "pass.Pz.z"}) {
        const FrameFile frame = stored(file("a.exr"), name, {3, 5});
        ASSERT_TRUE(frame.depth) << name;
        EXPECT_EQ(frame.depth->values, (std::vector<float>{3, 5})) << name;
        EXPECT_TRUE(frame.warnings.empty()) << name;
    }
    for (const char* const name : {"N", "P", "mask.R", "hitPzx", "depth_id.R"})
        EXPECT_FALSE(stored(file("a.exr"), name, {3, 5}).depth) << name;
    const FrameFile unreal = stored(file("a.exr"), "FinalImageMovieRenderQueue_WorldDepth.R", {300, 500});
    ASSERT_TRUE(unreal.depth);
    EXPECT_FLOAT_EQ(unreal.depth->values[0], 3);
    EXPECT_FLOAT_EQ(unreal.depth->values[1], 5);
}

TEST_F(ImageFrame, DepthHasAUnitADirectionAndAnInverse) {
    const auto depth = [&](std::array<float, 2> values, const FrameOptions& options) {
        return stored(file("a.exr"), "Z", values, options).depth->values;
    };
    EXPECT_EQ(depth({300, 1e12F}, {.depth_scale = 0.01}), (std::vector<float>{300 * 0.01F, sky_depth}));
    EXPECT_EQ(depth({0.25F, 0}, {.is_depth_inverse = true}), (std::vector<float>{4, sky_depth}));
    EXPECT_EQ(depth({0.25F, 0}, {.depth_scale = 2, .is_depth_inverse = true}), (std::vector<float>{8, sky_depth}));
    EXPECT_EQ(depth({-3, -5}, {}), (std::vector<float>{3, 5})) << "along an axis toward the viewer";
    EXPECT_EQ(depth({-3, 5}, {}), (std::vector<float>{-3, 5}));
    // What is asked for goes before what the name tells.
    EXPECT_EQ(stored(file("a.exr"), "WorldDepth.R", {300, 5}, {.depth_scale = 1}).depth->values[0], 300);
    const auto by_nuke = [](Imf::Header& header) { header.insert("nuke/version", Imf::StringAttribute("13")); };
    EXPECT_EQ(stored(file("a.exr"), "depth.Z", {0.25F, 0}, {}, by_nuke).warnings.size(), 1U);
    EXPECT_TRUE(stored(file("a.exr"), "depth.Z", {0.25F, 0}, {.is_depth_inverse = true}, by_nuke).warnings.empty());
    EXPECT_TRUE(stored(file("a.exr"), "depth.Z", {0.25F, 2}, {}, by_nuke).warnings.empty());
}

// What is seen at a pixel of the display window is seen there in the whole picture.
TEST_F(ImageFrame, OverscanIsKeptWhereAsked) {
    std::vector<float> values;
    for (int i = 0; i < 12 * 10; ++i) {
        for (int c = 0; c < 3; ++c) values.push_back(static_cast<float>(i));
        values.push_back(2);
    }
    test::store_floats(file("a.exr"), {"R", "G", "B", "Z"}, 12, values, [](Imf::Header& header) {
        header.dataWindow() = {{-3, -2}, {8, 7}};
        header.displayWindow() = {{0, 0}, {7, 5}};
    });
    const Result<FrameFile> usual = read_frame(file("a.exr"), {.vertical_field_of_view = 50});
    const Result<FrameFile> whole = read_frame(file("a.exr"), {.vertical_field_of_view = 50, .keeps_overscan = true});
    ASSERT_TRUE(usual && whole);
    EXPECT_FALSE(usual->display);
    EXPECT_EQ(usual->color.width, 8U);
    ASSERT_TRUE(whole->display);
    EXPECT_EQ(whole->color.width, 12U);
    EXPECT_EQ(whole->color.height, 10U);
    for (std::uint32_t y = 0; y < 6; ++y)
        for (std::uint32_t x = 0; x < 8; ++x)
            EXPECT_EQ(usual->color.at(x, y)[0], whole->color.at(x + 3, y + 2)[0]) << x << ", " << y;
    EXPECT_EQ(whole->color.at(11, 9)[0], 119);
    const auto pixel = [](const FrameFile& frame, const std::array<float, 3>& place) {
        std::array<double, 4> clip{};
        for (std::size_t row = 0; row < 4; ++row)
            clip[row] = (*frame.camera.projection)[row] * place[0] + (*frame.camera.projection)[4 + row] * place[1] +
                        (*frame.camera.projection)[8 + row] * place[2] + (*frame.camera.projection)[12 + row];
        return std::pair((clip[0] / clip[3] + 1) / 2 * frame.color.width,
                         (clip[1] / clip[3] + 1) / 2 * frame.color.height);
    };
    const auto [x, y] = pixel(*usual, {0.3F, -0.2F, -1.5F});
    const auto [whole_x, whole_y] = pixel(*whole, {0.3F, -0.2F, -1.5F});
    EXPECT_NEAR(whole_x, x + 3, 1e-5);
    EXPECT_NEAR(whole_y, y + 2, 1e-5);

    ASSERT_TRUE(write_picture(file("b.exr"), whole->color, {.display = whole->display}));
    const Result<FrameFile> again = read_frame(file("b.exr"), {.keeps_overscan = true});
    ASSERT_TRUE(again && again->display);
    EXPECT_EQ(again->color.pixels, whole->color.pixels);
    EXPECT_EQ(again->display->x, 3);
    EXPECT_EQ(again->display->height, 6U);
    EXPECT_EQ(read_frame(file("b.exr"))->color.pixels, usual->color.pixels);
}

TEST_F(ImageFrame, ViewsThatShareAPartAreTold) {
    const std::vector<float> values{1, 2, 3, 4, 5, 6, 7, 8};
    test::store_floats(file("a.exr"), {"R", "G", "B", "depth.Z", "left.R", "left.G", "left.B", "depth.left.Z"}, 1,
                       values, [](Imf::Header& header) {
                           Imf::addMultiView(header, {"right", "left"});
                       });
    const auto expect = [&](const std::string& view, float red, float depth) {
        const Result<FrameFile> frame = read_frame(file("a.exr"), {.view = view});
        ASSERT_TRUE(frame) << frame.error().text;
        EXPECT_EQ(frame->color.pixels[0], red) << view;
        ASSERT_TRUE(frame->depth) << view;
        EXPECT_EQ(frame->depth->values[0], depth) << view;
        EXPECT_EQ(frame->warnings.size(), view.empty() ? 1U : 0U);
    };
    expect("", 1, 4);
    expect("right", 1, 4);
    expect("left", 5, 8);
    const Result<FrameFile> other = read_frame(file("a.exr"), {.view = "up"});
    ASSERT_FALSE(other);
    EXPECT_TRUE(other.error().text.ends_with("has no view \"up\"; it has right, left")) << other.error().text;
}

TEST_F(ImageFrame, CameraComesFromAFileOrAFieldOfView) {
    FrameFile frame = full_frame();
    frame.camera = {};
    ASSERT_TRUE(write_frame(file("a.exr"), frame));
    const auto bare = read_frame(file("a.exr"));
    ASSERT_TRUE(bare);
    EXPECT_FALSE(bare->camera.projection);
    const auto wide = read_frame(file("a.exr"), {.vertical_field_of_view = 90});
    ASSERT_TRUE(wide);
    EXPECT_FLOAT_EQ((*wide->camera.projection)[5], -1.0f);
    EXPECT_FLOAT_EQ((*wide->camera.projection)[0], 3.0f / 5);
    EXPECT_FALSE(read_frame(file("a.exr"), {.vertical_field_of_view = 180}));

    put(file("c.toml"), "fov = 60\ncamera_to_world = [0,-1,0,4, 1,0,0,5, 0,0,1,6, 0,0,0,1]\n");
    const auto given = read_frame(file("a.exr"), {.camera_file = file("c.toml")});
    ASSERT_TRUE(given) << given.error().text;
    EXPECT_EQ(given->camera.vertical_field_of_view, 60);
    const Matrix& view = *given->camera.world_to_camera;  // of the point (4, 5, 6), the camera's own place: the origin
    for (std::size_t row = 0; row < 3; ++row)
        EXPECT_FLOAT_EQ(view[row] * 4 + view[4 + row] * 5 + view[8 + row] * 6 + view[12 + row], 0);
    EXPECT_FLOAT_EQ(view[4], 1);  // world y is camera x

    put(file("bad.toml"), "fov = 60\nfocal = 3\n");
    const auto bad = read_camera(file("bad.toml"));
    ASSERT_FALSE(bad);
    EXPECT_TRUE(bad.error().text.starts_with(file("bad.toml").string() + ":2: unknown key focal")) << bad.error().text;
    put(file("deep.toml"), "fov = " + std::string(1000, '['));
    const auto deep = read_camera(file("deep.toml"));
    ASSERT_FALSE(deep);
    EXPECT_NE(deep.error().text.find("depth of 16"), std::string::npos) << deep.error().text;
}

TEST(ImagePrimaries, Rec709IsUnchangedAndWhiteStaysWhite) {
    const auto same = to_rec709({});
    ASSERT_TRUE(same);
    for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR((*same)[i], i % 4 == 0 ? 1 : 0, 1e-12);
    // ACES AP0: other primaries, other white; its white becomes ours.
    const auto aces = to_rec709({{0.7347, 0.2653}, {0, 1}, {0.0001, -0.077}, {0.32168, 0.33767}});
    ASSERT_TRUE(aces);
    for (std::size_t row = 0; row < 3; ++row)
        EXPECT_NEAR((*aces)[row * 3] + (*aces)[row * 3 + 1] + (*aces)[row * 3 + 2], 1, 1e-9);
    EXPECT_NEAR((*aces)[0], 2.52169, 2e-3);  // ACES 1.0, AP0 to Rec. 709 with Bradford
    EXPECT_FALSE(to_rec709({{0.3, 0.3}, {0.3, 0.3}, {0.3, 0.3}, {0.3, 0.3}}));
}

TEST_F(ImageFrameData, TristimulusFileEqualsItsRec709Twin) {
    const auto xyz = read_frame(data_ / "exr/photos/XYZ.exr");
    const auto rgb = read_frame(data_ / "exr/photos/Rec709.exr");
    ASSERT_TRUE(xyz && rgb);
    double sum = 0;
    for (std::size_t i = 0; i < rgb->color.pixels.size(); ++i)
        sum += std::abs(xyz->color.pixels[i] - rgb->color.pixels[i]);
    EXPECT_LT(sum / static_cast<double>(rgb->color.pixels.size()), 3e-4);
}

TEST_F(ImageFrameData, BlenderLayersAreRecognised) {
    const auto frame =
        read_frame(data_ / "exr/render_interior/interior.0022.exr", {.normals_space = NormalsSpace::View});
    ASSERT_TRUE(frame) << frame.error().text;
    ASSERT_TRUE(frame->depth && frame->normals && frame->velocity);
    EXPECT_EQ(frame->color.width, 384u);
    EXPECT_EQ(frame->channels.size(), 19u);
    // Motion leads to where the pixel was: the colours of the previous frame there are nearer than those in place.
    const auto previous = read_frame(data_ / "exr/render_interior/interior.0021.exr");
    ASSERT_TRUE(previous);
    double moved = 0;
    double flipped = 0;
    for (std::uint32_t y = 20; y < 196; ++y)
        for (std::uint32_t x = 20; x < 364; ++x) {
            const float* motion = frame->velocity->at(x, y);
            if (std::abs(motion[1]) < 2) continue;  // says nothing about the direction of y
            const auto difference = [&](float sign) {
                const auto column = std::clamp<long>(std::lround(static_cast<float>(x) + motion[0]), 0, 383);
                const auto row = std::clamp<long>(std::lround(static_cast<float>(y) + sign * motion[1]), 0, 215);
                const float then =
                    previous->depth->at(static_cast<std::uint32_t>(column), static_cast<std::uint32_t>(row))[0];
                return std::min(1.0f, std::abs(then - frame->depth->at(x, y)[0]));
            };
            moved += difference(1);
            flipped += difference(-1);
        }
    EXPECT_LT(moved, 0.9 * flipped);
    std::size_t sky = 0;
    for (const float distance : frame->depth->values) sky += distance == sky_depth;
    for (const float distance : frame->depth->values) ASSERT_TRUE(distance > 0 && distance <= sky_depth);
    EXPECT_GT(sky, 0u);
}

TEST_F(ImageFrameData, VrayNormalsAreTurnedToTheWorld) {
    const auto frame = read_frame(data_ / "exr/vray_cornellBox_50ch.0001.exr");
    ASSERT_TRUE(frame) << frame.error().text;
    EXPECT_EQ(frame->color.width, 960u);
    ASSERT_TRUE(frame->normals && frame->camera.world_to_camera && frame->camera.projection);
    EXPECT_GT(frame->normals->at(480, 525)[2], 0.9f) << "the floor looks up, z there";
    EXPECT_LT(frame->normals->at(480, 10)[2], -0.9f) << "the ceiling looks down";
    const Matrix& view = *frame->camera.world_to_camera;
    EXPECT_FLOAT_EQ(view[9], 1) << "world z is up in the camera";
    EXPECT_NEAR(*frame->camera.vertical_field_of_view, 32.27, 0.05);
    EXPECT_EQ(frame->color.at(0, 0)[3], 0) << "outside the data window";
}

TEST_F(ImageFrameData, DataWindowIsPlacedInTheDisplayWindow) {
    const auto whole = read_frame(data_ / "exr/displaywindow/t01.exr");
    const auto cropped = read_frame(data_ / "exr/displaywindow/t05.exr");   // display from (30, 20), 340 x 260
    const auto bordered = read_frame(data_ / "exr/displaywindow/t08.exr");  // data from (30, 40) in 501 x 401
    ASSERT_TRUE(whole && cropped && bordered);
    EXPECT_EQ(cropped->color.width, 340u);
    EXPECT_EQ(bordered->color.width, 501u);
    for (std::uint32_t y = 0; y < 260; y += 13)
        for (std::uint32_t x = 0; x < 340; x += 11)
            for (int c = 0; c < 3; ++c) {
                ASSERT_EQ(cropped->color.at(x, y)[c], whole->color.at(x + 30, y + 20)[c]) << x << " " << y;
                ASSERT_EQ(bordered->color.at(x + 30, y + 40)[c], whole->color.at(x, y)[c]) << x << " " << y;
            }
    EXPECT_EQ(bordered->color.at(29, 40)[3], 0);
    EXPECT_EQ(bordered->color.at(30, 40)[3], 1);
}

TEST_F(ImageFrameData, EachViewOfManyPartsIsRead) {
    const std::filesystem::path file = data_ / "exr/beachball/multipart.0001.exr";
    const auto center = [&](const std::string& view) {
        const Result<FrameFile> frame = read_frame(file, {.view = view});
        EXPECT_TRUE(frame) << frame.error().text;
        return *std::max_element(frame->depth->values.begin(), frame->depth->values.end(),
                                 [](float a, float b) { return (a < sky_depth ? a : 0) < (b < sky_depth ? b : 0); });
    };
    EXPECT_NEAR(center("right"), 10.9219, 1e-4);
    EXPECT_NEAR(center("left"), 10.2578, 1e-4);
}

TEST_F(ImageFrameData, PartsOfOneViewBelongTogether) {
    const auto parts = read_frame(data_ / "exr/beachball/multipart.0001.exr");
    const auto single = read_frame(data_ / "exr/beachball/singlepart.0001.exr");
    ASSERT_TRUE(parts && single);
    EXPECT_EQ(parts->color, single->color);
    EXPECT_EQ(parts->depth->at(1000, 700)[0], single->depth->at(1000, 700)[0]);
    EXPECT_EQ(parts->channels.size(), 20u);
}

TEST_F(ImageFrameData, EveryFileIsReadOrRefusedForAKnownReason) {
    for (const char* folder : {"exr", "env"})
        for (const auto& entry : std::filesystem::recursive_directory_iterator(data_ / folder)) {
            const auto extension = entry.path().extension();
            if (extension != ".exr" && extension != ".hdr") continue;
            const std::string name = entry.path().stem().string();
            const auto frame = read_frame(entry.path());
            if (name == "deep_Trunks") {
                ASSERT_FALSE(frame) << name;
                EXPECT_NE(frame.error().text.find("has deep pixels"), std::string::npos) << frame.error().text;
            } else {
                EXPECT_TRUE(frame) << frame.error().text;
            }
        }
    const auto wide = read_frame(data_ / "exr/testimages/WideFloatRange.exr");
    ASSERT_TRUE(wide);
    EXPECT_EQ(wide->color.at(100, 100)[0], wide->color.at(100, 100)[2]) << "a lone channel is gray";
    const auto levels = read_frame(data_ / "exr/misc/ColorCodedLevels.exr");
    ASSERT_TRUE(levels);
    EXPECT_EQ(levels->color.width, 512u);
}

}  // namespace
}  // namespace darkroom
