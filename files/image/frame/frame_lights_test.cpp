// SPDX-License-Identifier: MIT
#include "image/frame/frame_lights.hpp"

#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfFloatVectorAttribute.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfStringAttribute.h>

#include <sys/resource.h>

#include <cmath>
#include <csignal>
#include <cstring>
#include <limits>

#include "image/test_files.hpp"

namespace darkroom {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

FrameLight light_with(std::uint32_t cascades, std::uint32_t side, float start) {
    FrameLight light{.direction = {0.1F, start, -1.0F / 3},
                     .color = {1e-30F, 7, 1.0F / 7},
                     .volumetric_intensity = start / 3,
                     .volumetric_color = {start, 0.3F, 0}};
    for (std::uint32_t c = 0; c < cascades; ++c) {
        FrameCascade cascade{.split = 10 * start + static_cast<float>(c) / 3, .depth = Plane<1>(side, side)};
        for (std::size_t i = 0; i < 16; ++i) cascade.world_to_cascade[i] = start + static_cast<float>(c * 16 + i) / 3;
        for (std::size_t i = 0; i < cascade.depth.values.size(); ++i)
            cascade.depth.values[i] = static_cast<float>(i + c) / static_cast<float>(side * side + cascades);
        light.cascades.push_back(std::move(cascade));
    }
    return light;
}

FrameFile frame_of(std::vector<FrameLight> lights) {
    FrameFile frame;
    frame.color = Picture(5, 3);
    frame.depth = Plane<1>(5, 3);
    frame.normals = Plane<3>(5, 3);
    for (std::size_t i = 0; i < frame.color.pixels.size(); ++i) frame.color.pixels[i] = static_cast<float>(i) / 8;
    for (std::size_t i = 0; i < 15; ++i) frame.depth->values[i] = 1.0F + static_cast<float>(i) / 3;
    for (std::size_t i = 0; i < 45; ++i) frame.normals->values[i] = static_cast<float>(i % 5) / 4 - 0.5F;
    frame.has_alpha = true;
    // Normals of a world that nobody places are left out.
    frame.camera.world_to_camera = Matrix{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    frame.time = 1.0 / 3;
    frame.lights = std::move(lights);
    return frame;
}

/// One of a frame's size, all of whose channels are 0.5.
ExrPart part_of(const char* name, const std::vector<std::string>& channels) {
    static const std::vector<float> values(256, 0.5F);
    ExrPart part{.header = exr_header(5, 3)};
    part.header.setName(name);
    for (const std::string& channel : channels)
        part.channels.push_back({.name = channel, .kind = SampleKind::Float, .values = values.data()});
    return part;
}

class ImageLights : public WithFolder {
  protected:
    [[nodiscard]] FrameFile read(const std::string& name, const FrameOptions& options = {}) const {
        Result<FrameFile> read = read_frame(file(name), options);
        EXPECT_TRUE(read) << read.error().text;
        return read ? std::move(*read) : FrameFile{};
    }
};

TEST_F(ImageLights, WhatIsWrittenIsReadBitForBit) {
    // The second casts no shadow, and shadows are larger than the picture or smaller.
    const FrameFile frame = frame_of({light_with(3, 16, 1), light_with(0, 0, 2), light_with(1, 2, 3)});
    ASSERT_TRUE(write_frame(file("a.exr"), frame));
    const FrameFile back = read("a.exr");
    EXPECT_EQ(back.lights, frame.lights);
    EXPECT_EQ(back.color, frame.color);
    EXPECT_EQ(back.depth, frame.depth);
    EXPECT_EQ(back.normals, frame.normals);
    EXPECT_EQ(back.time, frame.time);
    EXPECT_TRUE(back.warnings.empty());
    EXPECT_EQ(back.channels.back(), "shadow1.cascade0");
    EXPECT_EQ(file_count(), 1U) << "nothing is left beside it";

    ASSERT_TRUE(write_frame(file("b.exr"), frame));
    EXPECT_EQ(content(file("a.exr")), content(file("b.exr")));
}

TEST_F(ImageLights, EverySignOfZeroAndEveryLightThereMayBeIsKept) {
    std::vector<FrameLight> lights;
    for (std::size_t i = 0; i < max_frame_lights; ++i)
        lights.push_back(light_with(i % 4 == 3 ? 4 : 0, 3, static_cast<float>(i)));
    lights[3].cascades[2].depth.values[4] = -0.0F;
    ASSERT_TRUE(write_frame(file("a.exr"), frame_of(lights)));
    const FrameFile back = read("a.exr");
    EXPECT_EQ(back.lights, lights);
    EXPECT_TRUE(std::signbit(back.lights[3].cascades[2].depth.values[4]));
    lights.push_back({});
    const Result<> many = write_frame(file("b.exr"), frame_of(lights));
    ASSERT_FALSE(many);
    EXPECT_EQ(many.error().text,
              file("b.exr").string() + ": 17 lights, 4 of them with cascades; at most 16 and 4 are allowed");
    lights.pop_back();
    lights[0] = lights[3];
    EXPECT_FALSE(write_frame(file("b.exr"), frame_of(lights))) << "five with cascades";
}

TEST_F(ImageLights, WithoutCascadesTheFileHasOnePart) {
    ASSERT_TRUE(write_frame(file("none.exr"), frame_of({})));
    EXPECT_EQ(content(file("none.exr")).find("light"), std::string::npos);
    ASSERT_TRUE(write_frame(file("a.exr"), frame_of({light_with(0, 0, 1)})));
    constexpr std::size_t flags = 5;
    constexpr int multi_part_flag = 0x10;
    EXPECT_EQ(content(file("a.exr"))[flags] & multi_part_flag, 0);
    EXPECT_EQ(read("a.exr").lights, std::vector{light_with(0, 0, 1)});
    EXPECT_EQ(read("a.exr").channels.front(), "R");
    EXPECT_TRUE(read("none.exr").lights.empty());
}

TEST_F(ImageLights, DepthsMayStayInTheFile) {
    const FrameFile frame = frame_of({light_with(2, 8, 1)});
    ASSERT_TRUE(write_frame(file("a.exr"), frame));
    const FrameFile back = read("a.exr", {.has_shadow_depths = false});
    ASSERT_EQ(back.lights.size(), 1U);
    ASSERT_EQ(back.lights[0].cascades.size(), 2U);
    EXPECT_EQ(back.lights[0].cascades[1].world_to_cascade, frame.lights[0].cascades[1].world_to_cascade);
    EXPECT_TRUE(back.lights[0].cascades[1].depth.empty());
    EXPECT_EQ(back.color, frame.color);
    const Result<> again = write_frame(file("b.exr"), back);
    ASSERT_FALSE(again);
    EXPECT_NE(again.error().text.find("cascades of 0x0 texels"), std::string::npos) << again.error().text;
}

TEST_F(ImageLights, ShadowsAreNoLayerOfTheFrame) {
    FrameFile frame = frame_of({light_with(1, 4, 1)});
    ASSERT_TRUE(write_frame(file("a.exr"), frame));
    FrameOptions options;
    ASSERT_TRUE(add_mapping(options.names, "depth=G"));
    ASSERT_TRUE(add_mapping(options.names, "color=N"));
    EXPECT_EQ(read("a.exr", options).depth->values[1], 5.0F / 8) << "found as in a file of one part";
    // A lone channel is grey where nothing else is the colour.
    ExrPart lone = part_of("shadow3", {"Z"});
    std::vector<ExrPart> parts = shadow_parts(lone.header, frame.lights);
    parts.push_back(lone);
    ASSERT_TRUE(write_exr(file("b.exr"), parts));
    const auto alone = read_frame(file("b.exr"));
    ASSERT_FALSE(alone);
    EXPECT_NE(alone.error().text.find("has no color"), std::string::npos) << alone.error().text;
    ASSERT_TRUE(add_mapping(options.names, "color=shadow0.cascade0"));
    ASSERT_TRUE(add_mapping(options.names, "depth=shadow3.Z"));
    EXPECT_EQ(read("b.exr", options).color.at(1, 0)[1], frame.lights[0].cascades[0].depth.values[1])
        << "unless it is asked for";
}

TEST_F(ImageLights, WhatCouldNotBeReadIsNotWritten) {
    const auto refused = [&](const auto& change, const std::string& part) {
        FrameFile frame = frame_of({light_with(2, 4, 1)});
        change(frame.lights[0]);
        const Result<> written = write_frame(file("a.exr"), frame);
        ASSERT_FALSE(written) << part;
        EXPECT_NE(written.error().text.find(part), std::string::npos) << written.error().text;
        EXPECT_EQ(file_count(), 0U);
    };
    refused([](FrameLight& l) { l.direction[1] = infinity; }, "light 0: a number is not finite");
    refused([](FrameLight& l) { l.volumetric_intensity = std::nanf(""); }, "light 0: a number is not finite");
    refused([](FrameLight& l) { l.cascades[1].world_to_cascade[5] = infinity; }, "a number of a cascade is not finite");
    refused([](FrameLight& l) { l.cascades[0].split = infinity; }, "a number of a cascade is not finite");
    refused([](FrameLight& l) { l.cascades[1].depth = Plane<1>(5, 5); }, "its cascades differ in size");
    refused([](FrameLight& l) { l.cascades[0].depth = Plane<1>(4, 5); }, "4x5 texels; squares of [1, 16384]");
    refused([](FrameLight& l) { l.cascades[0].depth.width = l.cascades[0].depth.height = 16385; },
            "16385x16385 texels");
    refused([](FrameLight& l) { l.cascades.resize(5, l.cascades[0]); }, "5 cascades, at most 4 are allowed");
}

// At the start, and when the last bytes are written, which is when the codec closes the file.
TEST_F(ImageLights, AFullDiskIsNoticed) {
    const FrameFile frame = frame_of({light_with(1, 64, 1)});
    ASSERT_TRUE(write_frame(file("whole.exr"), frame));
    for (const rlim_t most : {rlim_t{100}, rlim_t{content(file("whole.exr")).size() - 1}}) {
        rlimit old{};
        getrlimit(RLIMIT_FSIZE, &old);
        const auto handler = std::signal(SIGXFSZ, SIG_IGN);
        const rlimit small{most, old.rlim_max};
        setrlimit(RLIMIT_FSIZE, &small);
        const Result<> written = write_frame(file("a.exr"), frame);
        setrlimit(RLIMIT_FSIZE, &old);
        std::signal(SIGXFSZ, handler);
        ASSERT_FALSE(written) << most;
        EXPECT_EQ(written.error().fault, Fault::Machine);
        EXPECT_TRUE(written.error().text.starts_with(file("a.exr").string() + ": ")) << written.error().text;
        EXPECT_EQ(file_count(), 1U);
    }
}

/// Files that write_frame would not make.
class ImageLightsHostile : public ImageLights {
  protected:
    template <class Change>
    void write(const Change& change) {
        frame_.lights = {light_with(2, 4, 1), light_with(1, 3, 2)};
        ExrPart frame = part_of("frame", {"R", "G", "B"});
        add_lights(frame.header, frame_.lights);
        std::vector<ExrPart> parts = shadow_parts(frame.header, frame_.lights);
        parts.insert(parts.begin(), frame);
        change(parts);
        const Result<> written = write_exr(file("a.exr"), parts);
        ASSERT_TRUE(written) << written.error().text;
    }
    template <class Change>
    void expect_refused(const std::string& text, const Change& change) {
        write(change);
        for (const bool has_depths : {true, false}) {
            const auto back = read_frame(file("a.exr"), {.has_shadow_depths = has_depths});
            ASSERT_FALSE(back) << text;
            EXPECT_EQ(back.error().text, file("a.exr").string() + ": " + text);
        }
    }
    FrameFile frame_;
};

using Parts = std::vector<ExrPart>;

// OpenEXR's own way to erase an attribute leaks it.
Imf::Header copy_without(const Imf::Header& header, const std::string& name) {
    Imf::Header out;
    for (auto attribute = header.begin(); attribute != header.end(); ++attribute)
        if (attribute.name() != name) out.insert(attribute.name(), attribute.attribute());
    return out;
}
auto set(const std::string& name, const Imf::Attribute& value) {
    return [name, copy = std::shared_ptr<const Imf::Attribute>(value.copy())](Parts& parts) {
        // Of an attribute that is there, the type cannot change.
        parts[0].header = copy_without(parts[0].header, name);
        parts[0].header.insert(name, *copy);
    };
}
auto set(const std::string& name, float value) { return set(name, Imf::FloatAttribute(value)); }
auto set(const std::string& name, int value) { return set(name, Imf::IntAttribute(value)); }
auto set(const std::string& name, const char* value) { return set(name, Imf::StringAttribute(value)); }
auto set_floats(const std::string& name, const std::vector<float>& values) {
    return set(name, Imf::FloatVectorAttribute(values));
}
auto without(const std::string& name) {
    return [=](Parts& parts) { parts[0].header = copy_without(parts[0].header, name); };
}
auto channels(std::size_t part, const std::vector<std::string>& names) {
    return [=](Parts& parts) { parts[part].channels = part_of("", names).channels; };
}

TEST_F(ImageLightsHostile, UnchangedItIsRead) {
    write([](Parts&) {});
    EXPECT_EQ(read("a.exr").lights, frame_.lights);
}

TEST_F(ImageLightsHostile, WrongNumbersAreRefused) {
    for (const auto& [value, shown] : std::vector<std::pair<float, std::string>>{
             {99, "99"}, {17, "17"}, {-1, "-1"}, {0.5F, "0.5"}, {1e30F, "1.0000000150474662e+30"}, {infinity, "inf"}})
        expect_refused("darkroom:lights = " + shown + "; whole numbers in [0, 16] are allowed",
                       set("darkroom:lights", value));
    const auto damaged = [](const std::string& name, int count) {
        return "darkroom:light" + name + " is missing or damaged; it has " + std::to_string(count) + " finite numbers";
    };
    expect_refused(damaged("2.direction", 3), set("darkroom:lights", 3));
    expect_refused(damaged("0.color", 3), without("darkroom:light0.color"));
    expect_refused(damaged("1.volumetricIntensity", 1), set("darkroom:light1.volumetricIntensity", "much"));
    expect_refused(damaged("0.volumetricColor", 3), set_floats("darkroom:light0.volumetricColor", {1, infinity, 1}));
    expect_refused(damaged("0.splits", 2), without("darkroom:light0.splits"));
    expect_refused(damaged("0.splits", 2), set_floats("darkroom:light0.splits", {1, 2, 3}));
    expect_refused(damaged("0.splits", 2), set_floats("darkroom:light0.splits", {1, std::nanf("")}));
    expect_refused(damaged("0.worldToCascade1", 16), without("darkroom:light0.worldToCascade1"));
    std::vector<float> matrix(16, 1);
    matrix[7] = std::nanf("");
    expect_refused(damaged("1.worldToCascade0", 16), set_floats("darkroom:light1.worldToCascade0", matrix));
}

TEST_F(ImageLightsHostile, WrongPartsAreRefused) {
    const std::string shadow = "darkroom:light0.shadow";
    expect_refused(shadow + " = 4; whole numbers in [0, 3] are allowed", set(shadow, 4));
    expect_refused(shadow + " = -1; whole numbers in [0, 3] are allowed", set(shadow, -1));
    expect_refused(shadow + " = 3; the file has no part shadow3", set(shadow, 3));
    expect_refused("darkroom:light1.shadow = 0; each light has shadows of its own", set("darkroom:light1.shadow", 0));
    expect_refused("shadow0 has 2 channels with cascade2 among them; cascade0 to cascade3 are allowed",
                   channels(1, {"cascade0", "cascade2"}));
    expect_refused("shadow0 has 1 channels with Z among them; cascade0 to cascade3 are allowed", channels(1, {"Z"}));
    expect_refused("shadow0 has 5 channels with cascade0 among them; cascade0 to cascade3 are allowed",
                   channels(1, {"cascade0", "cascade1", "cascade2", "cascade3", "cascade4"}));
    expect_refused("shadow1: cascades of 3x2 texels; squares of [1, 16384] a side are allowed",
                   [](Parts& parts) { parts[2].header.dataWindow().max.y = 1; });
}

TEST_F(ImageLightsHostile, WhatNoLightHasIsLeftOut) {
    write([](Parts& parts) {
        without("darkroom:lights")(parts);
        parts[2].header.setName("shadow123");
    });
    EXPECT_TRUE(read("a.exr").lights.empty());
    EXPECT_EQ(read("a.exr").warnings,
              std::vector<std::string>{"no light has the shadows shadow0 and 1 more: left out"});
    write(without("darkroom:light1.shadow"));
    const FrameFile back = read("a.exr");
    ASSERT_EQ(back.lights.size(), 2U);
    EXPECT_TRUE(back.lights[1].cascades.empty());
    EXPECT_EQ(back.lights[0], frame_.lights[0]);
    EXPECT_EQ(back.warnings, std::vector<std::string>{"no light has the shadows shadow1: left out"});
}

// What memory a picture takes follows from its display window, which shadows share and need not fill.
TEST_F(ImageLightsHostile, SmallShadowsMayBeBesideALargeFrame) {
    const auto write_of = [&](std::uint32_t side) {
        const std::vector<float> black(std::size_t{side} * side);
        ExrPart frame{.header = exr_header(side, side), .channels = {{.name = "Y", .values = black.data()}}};
        frame.header.setName("frame");
        frame.header.displayWindow().max = {8191, 8191};
        const std::vector<FrameLight> lights{light_with(1, 3, 1)};
        std::vector<ExrPart> parts = shadow_parts(frame.header, lights);
        parts.insert(parts.begin(), frame);
        return write_exr(file("a.exr"), parts);
    };
    ASSERT_TRUE(write_of(1024));
    EXPECT_TRUE(read_frame(file("a.exr")));
    ASSERT_TRUE(write_of(1023));
    const auto small = read_frame(file("a.exr"));
    ASSERT_FALSE(small);
    EXPECT_NE(small.error().text.find("out of proportion"), std::string::npos) << small.error().text;
}

TEST_F(ImageLightsHostile, DepthsAreMended) {
    // What is not finite is not written: it is put in place of other numbers.
    static const std::vector<float> stored{0.11F, 0.12F, 0.13F, -1, 2, 0.25F, 0, 1, 0.5F};
    write([](Parts& parts) {
        parts[2].header.compression() = Imf::NO_COMPRESSION;
        parts[2].channels[0].values = stored.data();
    });
    std::string bytes = content(file("a.exr"));
    const auto text = [](float value) { return std::string(reinterpret_cast<const char*>(&value), sizeof value); };
    for (const auto& [from, to] :
         {std::pair(0.11F, std::nanf("")), std::pair(0.12F, infinity), std::pair(0.13F, -infinity)})
        bytes.replace(bytes.rfind(text(from)), sizeof(float), text(to));
    put(file("a.exr"), bytes);
    const FrameFile back = read("a.exr");
    EXPECT_EQ(back.lights[1].cascades[0].depth.values, (std::vector<float>{1, 1, 1, 0, 1, 0.25F, 0, 1, 0.5F}));
    EXPECT_EQ(back.counts, PixelCounts{.not_finite_other = 3});
    ASSERT_EQ(back.warnings.size(), 2U);
    EXPECT_EQ(back.warnings[0], "shadow1: 2 depths are not in [0, 1]: clamped");
    EXPECT_TRUE(read("a.exr", {.has_shadow_depths = false}).warnings.empty());
}

// Cut anywhere, and with any byte of the header turned: an error or a frame, and nothing worse.
TEST_F(ImageLightsHostile, DamageIsRefusedOrHarmless) {
    write([](Parts&) {});
    const std::string whole = content(file("a.exr"));
    for (std::size_t size = 0; size < whole.size(); size += 37) {
        put(file("cut.exr"), whole.substr(0, size));
        EXPECT_FALSE(read_frame(file("cut.exr"))) << size;
    }
    for (std::size_t at = 8; at < whole.size(); at += 11) {
        std::string turned = whole;
        turned[at] = static_cast<char>(turned[at] ^ (1 << at % 8));
        put(file("turned.exr"), turned);
        const auto back = read_frame(file("turned.exr"));
        if (back) continue;
        EXPECT_TRUE(back.error().text.starts_with(file("turned.exr").string() + ": ")) << back.error().text;
    }
}

}  // namespace
}  // namespace darkroom
