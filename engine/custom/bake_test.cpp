// SPDX-License-Identifier: MIT
// Effects of users in files of kernels: compute passes, buffers, values and passes of several images need no compiler,
// and it does not matter where the effect's file lies.
#include <gtest/gtest.h>

#include <cstddef>
#include <darkroom/custom_effect.hpp>
#include <darkroom/kernel_file.hpp>
#include <string>
#include <vector>

#include "compose/test_stacks/host.hpp"
#include "core/files.hpp"
#include "gpu/kernel/kernel_store.hpp"
#include "gpu/shader/shader.hpp"
#include "tests/places.hpp"

namespace darkroom {
namespace {

using gpu::test::must;

std::string page_histogram() {
    const auto bytes = must(read_file(std::string(test::source_folder) + "/examples/histogram.glsl"));
    std::string out;
    for (const std::byte byte : bytes) out += static_cast<char>(byte);
    return out;
}

// A pass of several images, in compute or raster, and one that stores what it likes of two.
const std::string apart =
    "// @effect apart: Exchanges red and blue, and turns by half a turn.\n"
    "// @image low: 1 rgba32f\n// @image high: 1 rgba32f\n// @image turned: 1 rgba32f\n// @image kept: 1 rgba32f\n"
    "// @pass parts: picture -> low high\n"
    "void apart_parts(Pixel pixel, Apart parameters, out vec4 result[2]) {\n"
    "    vec4 color = load(picture, pixel.texel);\n    result[0] = color.bgra;\n    result[1] = 2.0 * color;\n}\n"
    "// @compute turn 8x8: low high -> turned kept\n"
    "void apart_turn(Apart parameters) {\n"
    "    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);\n"
    "    if (any(greaterThanEqual(texel, size(turned)))) return;\n"
    "    store(turned, size(turned) - 1 - texel, load(low, texel));\n"
    "    store(kept, texel, load(high, texel));\n}\n"
    "// @end turned kept\n"
    "vec4 apart(vec4 color, Pixel pixel, Apart parameters) {\n"
    "    return load(turned, pixel.texel) + 0.25 * load(kept, pixel.texel);\n}\n";

DeviceProfile own_profile() {
    return gpu::test::context().traits.is_software ? DeviceProfile::Software : DeviceProfile::Gpu;
}

std::vector<std::byte> baked(const CustomEffect& effect, const CompileDesc& desc) {
    Composer composer(Device::assumed(own_profile()));
    composer.add(effect.info(), nullptr);
    KernelFile file;
    must(file.add(composer, desc));
    return file.bytes();
}

Device without_compiler(std::span<const std::byte> kernels) {
    Device device = must(Device::create({.validate = true, .caches_on_disk = false, .kernels = kernels}));
    device.context().shaders->has_compiler = false;
    return device;
}

struct Outcome {
    ReferenceImage picture;
    std::vector<float> levels;
};
Outcome outcome_on(Device& device, const CustomEffect& effect, const ReferenceImage& picture) {
    const test::Host host(picture, VK_FORMAT_R32G32B32A32_SFLOAT, VK_FORMAT_R32G32B32A32_SFLOAT, device);
    Composer composer(device, {.frames_in_flight = 1});
    composer.add(effect.info(), nullptr);
    must(composer.compile(host.compile_desc()));
    for (int i = 0; i < 2; ++i) must(host.record(composer, host.frame()));
    const auto levels = composer.value("histogram.levels").numbers;
    return {host.read_target(), {levels.begin(), levels.end()}};
}

}  // namespace

TEST(ComposeCustomBake, ComputePassesBuffersAndValuesNeedNoCompiler) {
    const ReferenceImage picture = test::round_to_float(test::random_display(61, 33, 4));
    for (const std::string& text : {page_histogram(), apart}) {
        const CustomEffect here = must(CustomEffect::parse(text, "here/mine.glsl"));
        const CustomEffect elsewhere = must(CustomEffect::parse(text, "/quite/elsewhere.glsl"));
        const test::Host host(picture);
        Device device = without_compiler(baked(here, host.compile_desc()));
        const Outcome wanted = outcome_on(gpu::test::device(), here, picture),
                      got = outcome_on(device, elsewhere, picture);
        EXPECT_EQ(test::worst_difference(got.picture, wanted.picture), 0);
        EXPECT_EQ(got.levels, wanted.levels);
        EXPECT_EQ(wanted.levels.size(), text == apart ? 0U : 256U);
        EXPECT_EQ(device.context().shaders->compiled, 0U);
        EXPECT_EQ(device.validation_messages(), 0U);
    }
}

TEST(ComposeCustomBake, AFaultIsThatOfItsOwnFileAlthoughAnotherHasTheSameText) {
    const std::string text =
        "// @effect bad: Bad.\nvec4 bad(vec4 color, Pixel pixel, Bad parameters) { return nothing; }\n";
    for (const std::string name : {"one.glsl", "two.glsl", "one.glsl"}) {
        const CustomEffect effect = must(CustomEffect::parse(text, name));
        const test::Host host(test::uniform(4, 4, {}));
        Composer composer(host.device);
        composer.add(effect.info(), nullptr);
        const auto plan = composer.compile(host.compile_desc());
        ASSERT_FALSE(plan);
        EXPECT_NE(plan.error().text.find(name + ":2"), std::string::npos) << plan.error().text;
    }
}

TEST(ComposeCustomBake, AFaultIsRefusedInOneLineThatNamesTheFile) {
    const CustomEffect effect =
        must(CustomEffect::parse("// @effect bad: Bad.\n// @value one: 1\n// @compute one 1x1 1x1: -> one\n"
                                 "void bad_one(Bad parameters) {\n    one[0] = nothing;\n}\n// @end one\n"
                                 "vec4 bad(vec4 color, Pixel pixel, Bad parameters) { return color * one[0]; }\n",
                                 "bad.glsl"));
    Composer composer(Device::assumed(own_profile()));
    composer.add(effect.info(), nullptr);
    KernelFile file;
    const auto added = file.add(composer, test::Host(test::uniform(4, 4, {})).compile_desc());
    ASSERT_FALSE(added);
    EXPECT_NE(added.error().text.find("bad.glsl:5"), std::string::npos) << added.error().text;
    EXPECT_EQ(added.error().text.find('\n'), std::string::npos) << added.error().text;
    EXPECT_EQ(file.size(), 0U);
}

}  // namespace darkroom
