// SPDX-License-Identifier: MIT
// A host of baked kernels. It is built twice, with the compiler of GLSL and without (tests/CMakeLists.txt), and
// tests/scripts/bake.sh compares what both make.
//     baked_host profile                       the kind of device that runs here: gpu or software
//     baked_host LOOK OUT [KERNELS.dkb]        develops a made picture by the look, as it is, and then with one entry
//                                              switched or one toggle or choice changed at a time; the bytes of all
//                                              pictures go to OUT
// It prints how long the first record took, from nothing but a device, and how much of it the driver's pipelines are.

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <darkroom/look.hpp>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "core/files.hpp"
#include "develop/developer.hpp"
#include "gpu/device/context.hpp"
#include "gpu/resource/resources.hpp"
#include "gpu/shader/shader.hpp"

namespace {

using darkroom::Composer;
using darkroom::Device;

/// Of the CPU that this thread takes: other programs take none of it.
struct Clock {
    using duration = std::chrono::nanoseconds;
    static duration now() {
        timespec time{};
        clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
        return std::chrono::seconds(time.tv_sec) + std::chrono::nanoseconds(time.tv_nsec);
    }
};

constexpr VkExtent2D extent{256, 144};

double milliseconds(Clock::duration duration) { return std::chrono::duration<double, std::milli>(duration).count(); }

template <class T>
T must(darkroom::Result<T> result) {
    if (!result) {
        fmt::print(stderr, "baked_host: {}\n", result.error().text);
        std::exit(1);
    }
    if constexpr (!std::is_void_v<T>) return std::move(*result);
}

/// A floor that recedes, lamps over it, and a wall behind.
struct Scene {
    std::vector<std::uint16_t> color;
    std::vector<float> depth;
};
std::uint16_t half_of(double value) {
    int exponent = 0;
    const double mantissa = std::frexp(value, &exponent);
    if (value < 0x1p-14) return 0;
    return static_cast<std::uint16_t>(((exponent + 14) << 10) + static_cast<int>((mantissa * 2 - 1) * 1024));
}
Scene made_scene() {
    Scene out;
    for (std::uint32_t y = 0; y < extent.height; ++y)
        for (std::uint32_t x = 0; x < extent.width; ++x) {
            const bool is_floor = y > extent.height / 2;
            const bool is_lamp = x % 32 < 4 && y % 24 < 4, is_tile = ((x / 16 + y / 16) & 1) != 0;
            const double light = is_lamp ? 20.0 : is_tile ? 0.5 : 0.05;
            for (const double tint : {1.0, 0.8, 0.3 + 0.7 * x / extent.width})
                out.color.push_back(half_of(light * tint));
            out.color.push_back(half_of(1));
            out.depth.push_back(is_floor ? 200.0F / static_cast<float>(y + 1 - extent.height / 2) : 100.0F);
            if (x % 64 > 40) out.depth.back() = std::min(out.depth.back(), 6.0F);
        }
    return out;
}

/// The driver's part. Functions of Vulkan carry no pointer of the caller's, so it is global.
struct Pipelines {
    darkroom::gpu::Dispatch vk;
    Clock::duration spent{};
    std::size_t count = 0;
} pipelines;

template <class Create>
VkResult timed(const Create& create) {
    const Clock::duration start = Clock::now();
    const VkResult result = create();
    pipelines.spent += Clock::now() - start;
    ++pipelines.count;
    return result;
}
void watch_pipelines(darkroom::gpu::Context& context) {
    pipelines.vk = context.vk;
    context.vk.CreateComputePipelines = [](VkDevice device, VkPipelineCache cache, std::uint32_t count,
                                           const VkComputePipelineCreateInfo* infos,
                                           const VkAllocationCallbacks* allocator, VkPipeline* out) {
        return timed([&] { return pipelines.vk.CreateComputePipelines(device, cache, count, infos, allocator, out); });
    };
    context.vk.CreateGraphicsPipelines = [](VkDevice device, VkPipelineCache cache, std::uint32_t count,
                                            const VkGraphicsPipelineCreateInfo* infos,
                                            const VkAllocationCallbacks* allocator, VkPipeline* out) {
        return timed([&] { return pipelines.vk.CreateGraphicsPipelines(device, cache, count, infos, allocator, out); });
    };
}

darkroom::gpu::Image image_of(Device& device, const darkroom::ImageUse& use) {
    return must(darkroom::gpu::Image::create(
        device.context(),
        {.name = "the host's", .format = use.format, .extent = {extent.width, extent.height, 1}, .usage = use.usage}));
}
darkroom::ImageRef ref_of(const darkroom::gpu::Image& image) {
    return {.image = image.handle,
            .view = image.view,
            .format = image.info.format,
            .extent = extent,
            .layout = VK_IMAGE_LAYOUT_GENERAL,
            .final_layout = VK_IMAGE_LAYOUT_GENERAL};
}

/// The pictures hold nothing: what is measured is the way to the end of record(), by one thread.
void measure_first_record(Device& device, const darkroom::Look& look, const darkroom::CompileDesc& desc) {
    const darkroom::gpu::Image color = image_of(device, desc.color), depth = image_of(device, desc.depth),
                               target = image_of(device, desc.target);
    must(darkroom::gpu::submit_and_wait(device.context(), "preparing", [&](VkCommandBuffer commands) {
        for (const darkroom::gpu::Image* const image : {&color, &depth, &target})
            darkroom::gpu::transition(device.context(), commands, *image, VK_IMAGE_LAYOUT_UNDEFINED,
                                      VK_IMAGE_LAYOUT_GENERAL);
    }));
    watch_pipelines(device.context());
    std::optional<Composer> composer;
    darkroom::Result<> recorded;
    must(darkroom::gpu::submit_and_wait(device.context(), "the first frame", [&](VkCommandBuffer commands) {
        const Clock::duration start = Clock::now();
        composer.emplace(device, darkroom::ComposerDesc{.frames_in_flight = 1, .max_threads = 0});
        must(darkroom::apply(look, *composer));
        must(composer->compile(desc));
        recorded = composer->record(commands, {.color = ref_of(color),
                                               .depth = ref_of(depth),
                                               .camera = {.depth = darkroom::DepthKind::Planar},
                                               .target = ref_of(target)});
        const double all = milliseconds(Clock::now() - start), driver = milliseconds(pipelines.spent);
        fmt::print("first record: {:.2f} ms, {:.2f} of them {} pipelines of the driver, {:.2f} beyond\n", all, driver,
                   pipelines.count, all - driver);
    }));
    must(std::move(recorded));
    device.context().vk = pipelines.vk;
}

class Run {
  public:
    Run(Device& device, Composer& composer, const darkroom::DevelopInput& input)
        : developer_(device, {}), composer_(composer), input_(input) {}
    void add_picture() {
        const auto picture = must(developer_.develop(composer_, input_));
        const std::span<const std::byte> bytes = std::as_bytes(std::span(picture.bytes));
        out_.insert(out_.end(), bytes.begin(), bytes.end());
    }
    void add_switched(darkroom::Handle entry) {
        const bool is_on = composer_.desc(entry)->enabled;
        must(composer_.set_enabled(entry, !is_on));
        add_picture();
        must(composer_.set_enabled(entry, is_on));
        for (const darkroom::ParamInfo& row : composer_.info(entry)->parameters.rows) {
            const std::uint32_t before = composer_.words(entry)[row.word];
            const std::size_t values = row.kind == darkroom::Kind::Toggle ? 2 : row.choices.size();
            for (std::uint32_t value = 0; value < values && !row.is_at_compile; ++value) {
                must(composer_.set(entry, row.name, {&value, 1}));
                add_picture();
            }
            if (values > 0) must(composer_.set(entry, row.name, {&before, 1}));
        }
    }
    [[nodiscard]] const std::vector<std::byte>& pictures() const { return out_; }

  private:
    darkroom::Developer developer_;
    Composer& composer_;
    const darkroom::DevelopInput& input_;
    std::vector<std::byte> out_;
};

}  // namespace

int main(int argc, char** argv) {
    if (argc == 2 && std::string_view(argv[1]) == "profile") {
        fmt::print("{}\n", must(Device::create()).info().is_software ? "software" : "gpu");
        return 0;
    }
    if (argc < 3) return 1;
    std::vector<std::byte> kernels;
    if (argc > 3) kernels = must(darkroom::read_file(argv[3]));
    Device device = must(Device::create(
        {.log = [](darkroom::Severity, std::string_view text) { fmt::print(stderr, "baked_host: {}\n", text); },
         .caches_on_disk = kernels.empty(),
         .kernels = kernels}));
    const darkroom::Look look = must(darkroom::read_look(argv[1], {.allows_custom_effects = true}));
    const Scene scene = made_scene();
    const darkroom::DevelopInput input{.extent = extent,
                                       .depth = scene.depth,
                                       .color_halves = scene.color,
                                       .camera = {.depth = darkroom::DepthKind::Planar}};
    measure_first_record(device, look, darkroom::compile_desc_for(device, input, {}));
    Composer composer(device, {.max_threads = 0});
    must(darkroom::apply(look, composer));
    Run run(device, composer, input);
    run.add_picture();
    for (std::size_t i = 0; i < composer.size(); ++i) run.add_switched(composer.entry(i));
    must(darkroom::write_file(argv[2], run.pictures()));
    const darkroom::gpu::ShaderCompiler& shaders = *device.context().shaders;
    fmt::print("{} bytes of pictures, shaders: {} baked, {} cached, {} compiled\n", run.pictures().size(),
               shaders.from_baked.load(), shaders.from_cache.load(), shaders.compiled.load());
    return 0;
}
