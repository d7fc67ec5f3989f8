// SPDX-License-Identifier: MIT
#include "start.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>

#include "bare_start.hpp"
#include "bench/chain/chains.hpp"

namespace darkroom::bench {

namespace {

double now_ms() {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Milliseconds from nothing.
struct Start {
    double device = 0;    ///< the device is there
    double compiled = 0;  ///< the stack is compiled
    double dispatch = 0;  ///< the first frame is submitted
    double finished = 0;  ///< ... and done
};

struct StartRun {
    Start times;
    std::vector<BarePipeline> pipelines;  ///< where they were asked for
    std::vector<std::byte> pipeline_cache;
};

Result<std::vector<std::byte>> pipeline_cache_of(const gpu::Context& context) {
    std::size_t size = 0;
    const gpu::Dispatch& vk = context.vk;
    VkResult result = vk.GetPipelineCacheData(context.device, context.pipeline_cache, &size, nullptr);
    std::vector<std::byte> data(size);
    if (result == VK_SUCCESS)
        result = vk.GetPipelineCacheData(context.device, context.pipeline_cache, &size, data.data());
    DARKROOM_TRY(context.check(result, "reading the pipeline cache"));
    data.resize(size);
    return data;
}

/// What the host brings, its pictures and its command buffer, is not counted.
Result<StartRun> start(const std::string& select, VkExtent2D extent, const std::filesystem::path* notes_folder) {
    StartRun run;
    double since = now_ms();
    DARKROOM_TRY_VALUE(auto device, Device::create({.select = select}));
    run.times.device = now_ms() - since;
    DARKROOM_TRY_VALUE(auto bed, Bed::create(device, extent));
    DARKROOM_TRY_VALUE(auto submitter, Submitter::create(device.context()));
    DARKROOM_TRY_VALUE(auto commands, submitter->begin());
    std::optional<PipelineNotes> notes;
    if (notes_folder != nullptr) notes.emplace(device.context(), *notes_folder);

    since = now_ms() - run.times.device;
    Composer composer(device, {.frames_in_flight = 1});
    fill(composer, default_stack());
    DARKROOM_TRY(composer.compile(bed->compile_desc()));
    run.times.compiled = now_ms() - since;
    auto done = composer.record(commands, bed->frame());
    if (done) done = device.context().check(device.context().vk.EndCommandBuffer(commands), "ending a command buffer");
    if (done) done = submitter->submit();
    run.times.dispatch = now_ms() - since;
    if (done) done = submitter->wait();
    if (!done) return failure(std::move(done));
    run.times.finished = now_ms() - since;

    if (!notes) return run;
    DARKROOM_TRY_VALUE(run.pipelines, notes->take());
    DARKROOM_TRY_VALUE(run.pipeline_cache, pipeline_cache_of(device.context()));
    return run;
}

}  // namespace

Result<std::vector<Figure>> start_figures(const std::string& select, VkExtent2D extent, std::uint32_t rounds) {
    std::error_code error;
    const std::filesystem::path folder =
        std::filesystem::temp_directory_path(error) / fmt::format("darkroom_bench_{}", getpid());
    // This run also warms the caches.
    DARKROOM_TRY_VALUE(auto first, start(select, extent, &folder));
    DARKROOM_TRY_VALUE(auto device, Device::create({.select = select}));
    const std::string name = device.info().name;

    std::vector<double> bare, created, compiled, dispatch, finished, ratios;
    for (std::uint32_t round = 0; round <= rounds; ++round) {
        const auto own = start(select, extent, nullptr);
        const auto least = bare_start(name, first.pipelines, first.pipeline_cache);
        if (!own || !least) {
            std::filesystem::remove_all(folder, error);
            return failure(own ? least.error() : own.error());
        }
        if (round == 0) continue;
        bare.push_back(*least);
        created.push_back(own->times.device);
        compiled.push_back(own->times.compiled);
        dispatch.push_back(own->times.dispatch);
        finished.push_back(own->times.finished);
        ratios.push_back(own->times.dispatch / *least);
    }
    std::filesystem::remove_all(folder, error);
    return std::vector<Figure>{
        {"start: device created", median(created), "ms"},
        {"start: default stack compiled", median(compiled), "ms"},
        {"start: first dispatch submitted", median(dispatch), "ms"},
        {"start: first frame finished", median(finished), "ms"},
        {fmt::format("start: bare device and {} pipelines", first.pipelines.size()), median(bare), "ms"},
        {"start: first dispatch / bare", median(ratios), "", 1.5},
    };
}

}  // namespace darkroom::bench
