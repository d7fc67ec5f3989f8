// SPDX-License-Identifier: MIT
// What a host can get wrong about its images: each fault is refused with the image and the field, before anything is
// recorded.

#include "compose/test_stacks/host.hpp"
#include "compose/test_stacks/shadow_map.hpp"
#include "gpu/resource/formats.hpp"

namespace darkroom {
namespace {

constexpr VkExtent2D frame_extent{24, 18};

constexpr EffectFile files[] = {
    {"reader.glsl",
     "vec4 reader(vec4 color, Pixel pixel, Reader parameters) {\n"
     "    vec4 sum = load(reader_depth, pixel.texel) + load(reader_normals, pixel.texel);\n"
     "    sum += load(reader_velocity, pixel.texel) + load(reader_ui, pixel.texel);\n"
     "    sum += load(reader_reactive, pixel.texel) * load(reader_exposure, ivec2(0));\n"
     "    sum += load(reader_transparency, pixel.texel);\n"
     "    return color + sum * texture(reader_shadow, vec4(pixel.uv, 0.0, 0.5));\n}\n"},
};
void build_reader(PassBuilder& builder) {
    builder.side("reader_depth", builder.frame_image(FrameImage::Depth), {});
    builder.side("reader_normals", builder.frame_image(FrameImage::Normals), {});
    builder.side("reader_velocity", builder.frame_image(FrameImage::Velocity), {});
    builder.side("reader_ui", builder.frame_image(FrameImage::Ui), {});
    builder.side("reader_reactive", builder.frame_image(FrameImage::Reactive), {});
    builder.side("reader_transparency", builder.frame_image(FrameImage::Transparency), {});
    builder.side("reader_exposure", builder.frame_image(FrameImage::Exposure), {});
    builder.side("reader_shadow", builder.shadow_map(0), {});
}
/// Reads every image that a frame may bring.
const EffectInfo reader{.name = "reader",
                        .doc = "Adds every image of the frame.",
                        .parameters = {.struct_name = "Reader"},
                        .files = files,
                        .needs = {FrameImage::Depth, FrameImage::Normals, FrameImage::Velocity, FrameImage::Shadows,
                                  FrameImage::Ui, FrameImage::Reactive, FrameImage::Transparency, FrameImage::Exposure},
                        .build = build_reader};

ReferenceLight striped() {
    ReferenceLight light{.resolution = 2};
    light.cascades = {{0, 1, 1, 0}, {1, 1, 0, 0}};
    return light;
}

class ComposeFrameCheck : public ::testing::Test {
  protected:
    [[nodiscard]] gpu::Context& context() const { return host.device.context(); }
    [[nodiscard]] CompileDesc compile_desc() const {
        CompileDesc desc = host.compile_desc();
        desc.depth = {VK_FORMAT_R32_SFLOAT};
        desc.normals = {VK_FORMAT_R16G16B16A16_SFLOAT};
        desc.velocity = {VK_FORMAT_R16G16_SFLOAT};
        desc.ui = {VK_FORMAT_R8G8B8A8_UNORM};
        desc.reactive = {VK_FORMAT_R8G8B8A8_UNORM};
        desc.transparency = {VK_FORMAT_R16G16B16A16_SFLOAT};
        desc.exposure = {VK_FORMAT_R32_SFLOAT};
        desc.has_shadows = true;
        return desc;
    }
    [[nodiscard]] Frame frame() const {
        Frame frame = host.frame();
        frame.depth = test::image_ref(depth);
        frame.normals = test::image_ref(normals);
        frame.velocity = test::image_ref(velocity);
        frame.ui = test::image_ref(ui);
        frame.reactive = test::image_ref(reactive);
        frame.transparency = test::image_ref(transparency);
        frame.exposure = test::image_ref(exposure);
        frame.lights = lights;
        return frame;
    }
    void SetUp() override {
        lights[1].cascades = test::shadow_map_ref(shadow_map);
        lights[1].cascade_count = 2;
        composer.add(reader, nullptr);
        test::must(composer.compile(compile_desc()));
    }

    test::Host host{ReferenceImage(frame_extent.width, frame_extent.height, {0.5, 0.25, 0.125, 1})};
    gpu::test::Picture depth = gpu::test::blank(context(), frame_extent, VK_FORMAT_R32_SFLOAT);
    gpu::test::Picture normals = gpu::test::blank(context(), frame_extent, VK_FORMAT_R16G16B16A16_SFLOAT);
    gpu::test::Picture velocity = gpu::test::blank(context(), frame_extent, VK_FORMAT_R16G16_SFLOAT);
    gpu::test::Picture ui = gpu::test::blank(context(), frame_extent, VK_FORMAT_R8G8B8A8_UNORM);
    gpu::test::Picture transparency = gpu::test::blank(context(), frame_extent, VK_FORMAT_R16G16B16A16_SFLOAT);
    gpu::test::Picture reactive = gpu::test::blank(context(), frame_extent, VK_FORMAT_R8G8B8A8_UNORM);
    gpu::test::Picture exposure = gpu::test::blank(context(), {1, 1}, VK_FORMAT_R32_SFLOAT);
    gpu::Image shadow_map = test::upload_shadow_map(context(), striped());
    std::array<Light, 2> lights;  ///< the first casts no shadow
    Composer composer{host.device};
};

struct Fault {
    void (*spoil)(Frame& frame, Light& light);
    std::string_view text;
};

TEST_F(ComposeFrameCheck, EveryFaultNamesImageAndField) {
    const Fault faults[] = {
        {[](Frame& f, Light&) { f.color = {}; }, "frame.color is not given, and the plan reads it"},
        {[](Frame& f, Light&) { f.target = {}; }, "frame.target is not given, and the plan writes it"},
        {[](Frame& f, Light&) { f.depth.image = VK_NULL_HANDLE; }, "frame.depth.image is null"},
        {[](Frame& f, Light&) { f.normals.view = VK_NULL_HANDLE; }, "frame.normals.view is null"},
        {[](Frame& f, Light&) { f.target.image = VK_NULL_HANDLE; }, "frame.target.image is null"},
        {[](Frame& f, Light&) { f.color.layout = VK_IMAGE_LAYOUT_UNDEFINED; }, "frame.color.layout is UNDEFINED"},
        {[](Frame& f, Light&) { f.depth.layout = VK_IMAGE_LAYOUT_UNDEFINED; }, "frame.depth.layout is UNDEFINED"},
        {[](Frame& f, Light&) { f.ui.layout = VK_IMAGE_LAYOUT_UNDEFINED; }, "frame.ui.layout is UNDEFINED"},
        {[](Frame& f, Light&) { f.velocity.final_layout = VK_IMAGE_LAYOUT_PREINITIALIZED; },
         "frame.velocity.final_layout is PREINITIALIZED"},
        {[](Frame& f, Light&) { f.depth.format = VK_FORMAT_D32_SFLOAT; },
         "frame.depth.format is D32_SFLOAT: allowed is R32_SFLOAT, as compiled"},
        {[](Frame& f, Light&) { f.ui.format = VK_FORMAT_R8G8B8A8_SRGB; }, "frame.ui.format is R8G8B8A8_SRGB"},
        {[](Frame& f, Light&) {
             f.color.extent = {0, 18};
         },
         "frame.color.extent is 0x18"},
        {[](Frame& f, Light&) {
             f.velocity.extent = {24, 0};
         },
         "frame.velocity.extent is 24x0"},
        {[](Frame& f, Light&) {
             f.color.extent = {25, 18};
         },
         "frame.color is 25x18: allowed is 1x1 to 24x18, as compiled; a part of an image is its region"},
        {[](Frame& f, Light&) {
             f.color.region = {{0, 0}, {12, 0}};
         },
         "frame.color is 12x0: allowed is 1x1 to 24x18"},
        {[](Frame& f, Light&) {
             f.normals.extent = {23, 18};
         },
         "frame.normals is 23x18: with a color of 24x18 it must be 24x18; a part of an image is its region"},
        {[](Frame& f, Light&) {
             f.reactive.extent = {24, 17};
         },
         "frame.reactive is 24x17: with a color of 24x18"},
        {[](Frame& f, Light&) {
             f.transparency.extent = {12, 9};
         },
         "frame.transparency is 12x9: with a color of 24x18"},
        {[](Frame& f, Light&) {
             f.exposure.extent = {2, 1};
         },
         "frame.exposure is 2x1: allowed is one texel"},
        {[](Frame& f, Light&) { f.exposure.format = VK_FORMAT_R16_SFLOAT; },
         "frame.exposure.format is R16_SFLOAT: allowed is R32_SFLOAT, as compiled"},
        {[](Frame& f, Light&) {
             f.depth.region = {{1, 0}, {24, 18}};
         },
         "frame.depth.region, 24x18 from (1, 0)"},
        {[](Frame& f, Light&) {
             f.ui.region = {{-1, 0}, {24, 18}};
         },
         "frame.ui.region, 24x18 from (-1, 0)"},
        // 2^32 + 8 together, which must not wrap around.
        {[](Frame& f, Light&) {
             f.target.region = {{16, 0}, {4294967288u, 18}};
         },
         "frame.target.region"},
        {[](Frame& f, Light&) {
             f.target.region = {{0, 0}, {24, 17}};
         },
         "frame.target is 24x17: with a color of"},
        {[](Frame& f, Light&) { f.velocity.layer_count = 2; }, "frame.velocity.layer_count is 2: allowed is 1"},
        {[](Frame& f, Light&) { f.view = 1; }, "frame.view is 1: allowed is [0, 0]"},
        {[](Frame& f, Light&) { f.target.image = f.color.image; }, "frame.color.image is that of frame.target"},
        {[](Frame& f, Light&) { f.ui.image = f.normals.image; }, "frame.ui.image is that of frame.normals"},
        {[](Frame& f, Light& l) { f.depth.image = l.cascades.image; },
         "frame.lights[1].cascades.image is that of frame.depth"},
        {[](Frame&, Light& l) { l.cascades.image = VK_NULL_HANDLE; }, "frame.lights[1].cascades.image is null"},
        {[](Frame&, Light& l) { l.cascades.view = VK_NULL_HANDLE; }, "frame.lights[1].cascades.view is null"},
        {[](Frame&, Light& l) { l.cascades.layout = VK_IMAGE_LAYOUT_UNDEFINED; },
         "frame.lights[1].cascades.layout is UNDEFINED"},
        {[](Frame&, Light& l) { l.cascades.format = VK_FORMAT_D16_UNORM; },
         "frame.lights[1].cascades.format is D16_UNORM: allowed is D32_SFLOAT"},
        {[](Frame&, Light& l) {
             l.cascades.extent = {0, 0};
         },
         "frame.lights[1].cascades.extent is 0x0"},
        {[](Frame&, Light& l) {
             l.cascades.extent = {2, 1};
         },
         "frame.lights[1].cascades.extent is 2x1: allowed are"},
        {[](Frame&, Light& l) {
             l.cascades.region = {{0, 0}, {1, 1}};
         },
         "frame.lights[1].cascades.region is 1x1"},
        {[](Frame&, Light& l) { l.cascades.layer_count = 1; },
         "frame.lights[1].cascades.layer_count is 1: allowed is cascade_count = 2 and more"},
        {[](Frame&, Light& l) { l.cascade_count = 5; }, "frame.lights[1].cascade_count is 5: allowed is [0, 4]"},
    };
    for (const Fault& fault : faults) {
        SCOPED_TRACE(fault.text);
        const Light sound = lights[1];
        Frame spoilt = frame();
        fault.spoil(spoilt, lights[1]);
        // Without a command buffer: the first command that is recorded ends the program.
        const auto recorded = composer.record(VK_NULL_HANDLE, spoilt);
        lights[1] = sound;
        ASSERT_FALSE(recorded);
        EXPECT_NE(recorded.error().text.find(fault.text), std::string::npos) << recorded.error().text;
        EXPECT_EQ(recorded.error().text.find('\n'), std::string::npos);
    }
    test::must(host.record(composer, frame()));
}

TEST_F(ComposeFrameCheck, WhatTheHostMayDoIsAllowed) {
    Frame allowed = frame();
    allowed.target.layout = VK_IMAGE_LAYOUT_UNDEFINED;
    test::must(host.record(composer, allowed));
    // Lights without shadows bring no image; what is not compiled for is not looked at.
    lights[1].cascades = {};
    test::must(host.record(composer, frame()));
    lights[1].cascade_count = 0;
    test::must(host.record(composer, frame()));
    Composer plain(host.device);
    test::add(plain, "exposure");
    test::must(plain.compile(host.compile_desc()));
    Frame odd = host.frame();
    odd.depth.format = VK_FORMAT_D16_UNORM;
    test::must(host.record(plain, odd));
}

TEST_F(ComposeFrameCheck, OneImageMayBeTwoInputsThatStayAsTheyAre) {
    Frame twice = frame();
    twice.ui = twice.color;
    CompileDesc desc = compile_desc();
    desc.color.usage = VK_IMAGE_USAGE_SAMPLED_BIT;
    desc.ui = desc.color;
    test::must(composer.compile(desc));
    const auto refused = composer.record(VK_NULL_HANDLE, twice);
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().text.find("SHADER_READ_ONLY_OPTIMAL"), std::string::npos) << refused.error().text;
    test::must(gpu::submit_and_wait(context(), "moving the colour", [&](VkCommandBuffer commands) {
        gpu::transition(context(), commands, host.color.image, host.color.layout,
                        VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    }));
    host.color.layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    twice.color = twice.ui = test::image_ref(host.color);
    test::must(host.record(composer, twice));
}

TEST_F(ComposeFrameCheck, APromiseThatIsNotKeptIsRefused) {
    CompileDesc desc = compile_desc();
    desc.is_depth_planar = true;
    desc.is_velocity_plain = true;
    test::must(composer.compile(desc));
    const auto error = [&](const Frame& given) {
        const auto recorded = composer.record(VK_NULL_HANDLE, given);
        return recorded ? std::string("recorded") : recorded.error().text;
    };
    Frame planar = frame();
    EXPECT_NE(error(planar).find("frame.camera.depth is not Planar"), std::string::npos) << error(planar);
    planar.camera.depth = DepthKind::Planar;
    planar.camera.velocity.unit = VelocityKind::Unit::Uv;
    EXPECT_NE(error(planar).find("frame.camera.velocity is not the default"), std::string::npos) << error(planar);
    planar.camera.velocity = {};
    test::must(host.record(composer, planar));
}

struct CompileFault {
    void (*spoil)(CompileDesc& desc);
    std::string_view text;
};

TEST_F(ComposeFrameCheck, CompileRefusesImagesThatNoFrameCanBring) {
    constexpr VkImageUsageFlags transfer = VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
    const CompileFault faults[] = {
        {[](CompileDesc& d) { d.color.format = VK_FORMAT_UNDEFINED; }, "color.format = UNDEFINED"},
        {[](CompileDesc& d) { d.color.usage = transfer; }, "color.usage = 0x1: allowed are usages with SAMPLED"},
        {[](CompileDesc& d) { d.depth.usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT; }, "depth.usage = 0x20"},
        {[](CompileDesc& d) { d.normals.usage = VK_IMAGE_USAGE_STORAGE_BIT; }, "normals.usage = 0x8"},
        {[](CompileDesc& d) { d.velocity.usage = 0; }, "velocity.usage = 0x0"},
        {[](CompileDesc& d) { d.ui.usage = transfer; }, "ui.usage = 0x1"},
        {[](CompileDesc& d) { d.depth.format = VK_FORMAT_R8G8B8A8_UNORM; },
         "depth.format = R8G8B8A8_UNORM: allowed are depth formats, R32_SFLOAT, R16_SFLOAT and R16_UNORM"},
        {[](CompileDesc& d) { d.depth.format = VK_FORMAT_S8_UINT; }, "depth.format = "},
        {[](CompileDesc& d) { d.target.usage = VK_IMAGE_USAGE_SAMPLED_BIT; },
         "target.usage = 0x4: allowed are usages with COLOR_ATTACHMENT or STORAGE"},
        {[](CompileDesc& d) { d.target.format = VK_FORMAT_D32_SFLOAT; }, "target.format = D32_SFLOAT"},
        {[](CompileDesc& d) { d.target.format = VK_FORMAT_BC7_UNORM_BLOCK; }, "target.format = "},
        {[](CompileDesc& d) { d.target.format = VK_FORMAT_UNDEFINED; }, "target.format = "},
        {[](CompileDesc& d) {
             d.target_extent = {64, 0};
         },
         "target_extent 64x0"},
        {[](CompileDesc& d) {
             d.target_extent = {1u << 20, 4};
         },
         "target_extent 1048576x4"},
    };
    for (const CompileFault& fault : faults) {
        SCOPED_TRACE(fault.text);
        CompileDesc desc = compile_desc();
        fault.spoil(desc);
        const auto plan = composer.compile(desc);
        ASSERT_FALSE(plan);
        EXPECT_NE(plan.error().text.find(fault.text), std::string::npos) << plan.error().text;
        EXPECT_EQ(plan.error().text.find('\n'), std::string::npos);
    }
    // A compile that is refused leaves the plan before it.
    test::must(host.record(composer, frame()));
    for (const VkFormat format : {VK_FORMAT_D16_UNORM, VK_FORMAT_D32_SFLOAT, VK_FORMAT_D32_SFLOAT_S8_UINT,
                                  VK_FORMAT_D24_UNORM_S8_UINT, VK_FORMAT_X8_D24_UNORM_PACK32, VK_FORMAT_R16_SFLOAT}) {
        if (!context().supports(format, VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT)) continue;
        CompileDesc desc = compile_desc();
        desc.depth.format = format;
        test::must(composer.compile(desc));
    }
}

// Shaders sample and write floats: of integers they would make a picture of zeros.
TEST_F(ComposeFrameCheck, IntegersAreNoPictures) {
    Composer planned(Device::assumed());
    test::add(planned, "tonemap");
    const auto error = [&](const CompileDesc& desc) {
        const auto plan = planned.plan(desc);
        return plan ? std::string("none") : plan.error().text;
    };
    for (const VkFormat format : {VK_FORMAT_R16G16B16A16_UINT, VK_FORMAT_R8G8B8A8_SINT, VK_FORMAT_R32_UINT}) {
        const std::string name(gpu::format_name(format));
        EXPECT_EQ(
            error({.max_extent = {64, 32}, .color = {format}}),
            fmt::format("compile: color.format = {}: allowed are formats that this device can sample, and none of "
                        "integers",
                        name));
        EXPECT_NE(error({.max_extent = {64, 32}, .normals = {format}}).find("compile: normals.format = " + name),
                  std::string::npos);
        EXPECT_EQ(
            error({.max_extent = {64, 32}, .target = {format, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT}}),
            fmt::format("compile: target.format = {}: allowed are colour formats that this device can render to or "
                        "store; depth, integer and block-compressed ones are none",
                        name));
    }
    EXPECT_EQ(error({.max_extent = {64, 32}}), "none");
}

}  // namespace
}  // namespace darkroom
