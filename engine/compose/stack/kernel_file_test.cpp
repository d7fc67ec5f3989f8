// SPDX-License-Identifier: MIT
// Kernels that were baked: a device that has them needs no compiler, gives the same bits whatever is switched, and says
// what it lacks.
#include <fmt/format.h>
#include <darkroom/kernel_file.hpp>

#include <mutex>

#include "compose/test_stacks/host.hpp"
#include "gpu/shader/shader.hpp"

namespace darkroom {
namespace {

using test::add;
using test::Host;
using test::must;

class ComposeKernelFile : public test::StackTest {
  protected:
    static void fill(Composer& composer) {
        add(composer, "bloom", {{"intensity", 0.3}}, {.source = scene_color});
        add(composer, "exposure", {{"exposure", 1.5}});
        add(composer, "tonemap");
        add(composer, "vignette", {{"intensity", 0.4}});
        add(composer, "gaussian_blur", {{"radius", 3}});
        add(composer, "encode");
        add(composer, "dither");
    }
    static DeviceProfile profile() {
        return gpu::test::context().traits.is_software ? DeviceProfile::Software : DeviceProfile::Gpu;
    }
    static CompileDesc desc() {
        const auto usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT;
        return {.max_extent = extent,
                .color = {VK_FORMAT_R16G16B16A16_SFLOAT, usage},
                .target = {VK_FORMAT_R8G8B8A8_UNORM, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_STORAGE_BIT}};
    }
    static std::vector<std::byte> bake(DeviceProfile profile, const std::function<void(Composer&)>& with = fill) {
        Composer composer(Device::assumed(profile));
        with(composer);
        KernelFile file;
        must(file.add(composer, desc()));
        return file.bytes();
    }
    /// Of the test device's kind, without a compiler.
    Device device_with(std::span<const std::byte> kernels) {
        Device device = must(Device::create({.log =
                                                 [this](Severity severity, std::string_view text) {
                                                     const std::scoped_lock lock(mutex);
                                                     EXPECT_LT(severity, Severity::Warning) << text;
                                                     said.emplace_back(text);
                                                 },
                                             .caches_on_disk = false,
                                             .kernels = kernels}));
        device.context().shaders->has_compiler = false;
        return device;
    }
    /// The same device with a compiler; the test device may be another one.
    static Device plain_device() {
        return must(Device::create({.cache_folder = ::testing::TempDir() + "darkroom_test_cache"}));
    }
    static Host host_on(Device& device) {
        return Host(test::random_hdr(extent.width, extent.height, 3), VK_FORMAT_R16G16B16A16_SFLOAT,
                    VK_FORMAT_R8G8B8A8_UNORM, device);
    }
    /// How many pieces of text that were said have this part.
    [[nodiscard]] std::ptrdiff_t said_with(std::string_view part) const {
        return std::ranges::count_if(said,
                                     [&](const std::string& text) { return text.find(part) != std::string::npos; });
    }

    static constexpr VkExtent2D extent{128, 72};
    std::mutex mutex;
    std::vector<std::string> said;
};

/// One thing after another is switched on both, and all pictures are compared.
void expect_same_pictures(const Host& host, Composer& composer, const Host& other_host, Composer& other) {
    const auto expect_same = [&](const std::string& what) {
        composer.wait_for_kernels();
        other.wait_for_kernels();
        EXPECT_EQ(test::worst_difference(host.run(composer), other_host.run(other)), 0) << what;
    };
    expect_same("as it is");
    for (std::size_t i = 0; i < composer.size(); ++i) {
        const Handle one = composer.entry(i), two = other.entry(i);
        const auto set_enabled = [&](bool on) {
            must(composer.set_enabled(one, on));
            must(other.set_enabled(two, on));
        };
        set_enabled(false);
        expect_same(composer.desc(one)->name + " off");
        set_enabled(true);
        for (const ParamInfo& row : composer.info(one)->parameters.rows) {
            if (row.is_at_compile) continue;
            const std::uint32_t before = composer.words(one)[row.word];
            const std::size_t values = row.kind == Kind::Toggle ? 2 : row.choices.size();
            for (std::uint32_t value = 0; value < values; ++value) {
                test::set_word(composer, one, row.name, value);
                test::set_word(other, two, row.name, value);
                expect_same(fmt::format("{}.{} = {}", composer.desc(one)->name, row.name, value));
            }
            if (values == 0) continue;
            test::set_word(composer, one, row.name, before);
            test::set_word(other, two, row.name, before);
        }
    }
}

TEST_F(ComposeKernelFile, GivesTheSameBitsWithoutACompilerWhateverIsSwitched) {
    const std::vector<std::byte> kernels = bake(profile());
    Device baked = device_with(kernels), plain = plain_device();
    const Host host = host_on(baked), other_host = host_on(plain);
    Composer composer(baked, {.max_threads = 0}), other(plain, {.max_threads = 0});
    fill(composer);
    fill(other);
    must(composer.compile(desc()));
    must(other.compile(desc()));
    expect_same_pictures(host, composer, other_host, other);
    EXPECT_EQ(baked.context().shaders->compiled, 0U);
    EXPECT_GT(baked.context().shaders->from_baked, 20U);
    EXPECT_EQ(said_with("it is not among"), 0) << said.front();
    EXPECT_EQ(baked.validation_messages(), 0U);
}

TEST_F(ComposeKernelFile, TheOtherProfileServesThisDeviceToo) {
    const DeviceProfile other_kind = profile() == DeviceProfile::Gpu ? DeviceProfile::Software : DeviceProfile::Gpu;
    const std::vector<std::byte> kernels = bake(other_kind);
    Device baked = device_with(kernels), plain = plain_device();
    const Host host = host_on(baked), other_host = host_on(plain);
    Composer composer(baked, {.max_threads = 0}), other(plain, {.max_threads = 0});
    fill(composer);
    fill(other);
    must(composer.compile(desc()));
    must(other.compile(desc()));
    EXPECT_LE(test::worst_codes(host.run(composer), other_host.run(other)), 1);
    EXPECT_EQ(baked.context().shaders->compiled, 0U);
}

TEST_F(ComposeKernelFile, AKernelThatWasNotBakedIsNamedWithItsEntries) {
    const std::vector<std::byte> kernels = bake(profile());
    Device baked = device_with(kernels);
    Composer composer(baked, {.max_threads = 0});
    fill(composer);
    add(composer, "negative", {}, {.name = "inverted"});
    const auto plan = composer.compile(desc());
    ASSERT_FALSE(plan);
    EXPECT_NE(plan.error().text.find("inverted"), std::string::npos) << plan.error().text;
    EXPECT_NE(plan.error().text.find("it is not among the"), std::string::npos) << plan.error().text;
    EXPECT_EQ(plan.error().text.find('\n'), std::string::npos) << plan.error().text;
}

// Two switches at once: nobody baked that lean kernel.
TEST_F(ComposeKernelFile, AMissingLeanKernelIsToldOnceAndTheCompleteOneGivesItsPicture) {
    const std::vector<std::byte> kernels = bake(profile());
    Device baked = device_with(kernels), plain = plain_device();
    const Host host = host_on(baked), other_host = host_on(plain);
    Composer composer(baked, {.max_threads = 0}), other(plain, {.max_threads = 0});
    for (Composer* const one : {&composer, &other}) {
        fill(*one);
        must(one->compile(desc()));
        for (const std::size_t entry : {std::size_t{1}, std::size_t{3}})
            must(one->set_enabled(one->entry(entry), false));
        one->wait_for_kernels();
    }
    EXPECT_GE(said_with("the complete kernel"), 1);
    const std::size_t before = said.size();
    EXPECT_EQ(test::worst_difference(host.run(composer), other_host.run(other)), 0);
    composer.wait_for_kernels();
    EXPECT_EQ(said.size(), before) << said.back();
}

TEST_F(ComposeKernelFile, RefusesWhatItCannotBake) {
    KernelFile file;
    Composer on_a_device(gpu::test::device());
    fill(on_a_device);
    const auto real = file.add(on_a_device, desc());
    ASSERT_FALSE(real);
    EXPECT_NE(real.error().text.find("Device::assumed()"), std::string::npos) << real.error().text;
    Composer on_gpu(Device::assumed()), on_cpu(Device::assumed(DeviceProfile::Software));
    add(on_gpu, "negative");
    add(on_cpu, "negative");
    must(file.add(on_gpu, desc()));
    const std::size_t count = file.size();
    EXPECT_GE(count, 2U);
    must(file.add(on_gpu, desc()));
    EXPECT_EQ(file.size(), count) << "the same again";
    const auto mixed = file.add(on_cpu, desc());
    ASSERT_FALSE(mixed);
    EXPECT_NE(mixed.error().text.find("profile software"), std::string::npos) << mixed.error().text;
    const auto device = Device::create({.kernels = std::as_bytes(std::span(std::string_view("no kernels at all")))});
    ASSERT_FALSE(device);
    EXPECT_NE(device.error().text.find("not a file that"), std::string::npos) << device.error().text;
}

}  // namespace
}  // namespace darkroom
