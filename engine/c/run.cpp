// SPDX-License-Identifier: MIT
// Plans and frames, and what recordings tell.
#include <darkroom/temporal_check.hpp>

#include "c/frame_of.hpp"

namespace darkroom::c {

namespace {

/// A plan as the caller's object, where it wants one.
void give(Plan plan, DarkroomPlan* out) {
    if (out != nullptr) *out = new DarkroomPlanObject{std::move(plan)};
}

}  // namespace

}  // namespace darkroom::c

using namespace darkroom;
using namespace darkroom::c;

DarkroomResult darkroom_composer_compile(DarkroomComposer composer, const DarkroomCompileDesc* given,
                                         DarkroomPlan* plan) {
    return call("darkroom_composer_compile", [&]() -> Result<> {
        DARKROOM_TRY(needs("composer", composer, "desc", given));
        DARKROOM_TRY_VALUE(const auto desc, compile_desc_of(given));
        DARKROOM_TRY_VALUE(auto made, composer->composer.compile(desc));
        give(std::move(made), plan);
        return {};
    });
}

DarkroomResult darkroom_composer_compile_later(DarkroomComposer composer, const DarkroomCompileDesc* given) {
    return call("darkroom_composer_compile_later", [&]() -> Result<> {
        DARKROOM_TRY(needs("composer", composer, "desc", given));
        DARKROOM_TRY_VALUE(const auto desc, compile_desc_of(given));
        return composer->composer.compile_later(desc);
    });
}

DarkroomResult darkroom_composer_pending(DarkroomComposer composer, VkBool32* is_pending) {
    return call("darkroom_composer_pending", [&]() -> Result<> {
        DARKROOM_TRY(needs("composer", composer, "is_pending", is_pending));
        const PendingCompile pending = composer->composer.pending();
        *is_pending = pending.is_pending;
        return pending.error ? failure(*pending.error) : Result<>{};
    });
}

DarkroomResult darkroom_composer_coming_plan(DarkroomComposer composer, DarkroomPlan* plan) {
    return call("darkroom_composer_coming_plan", [&]() -> Result<> {
        DARKROOM_TRY(needs("composer", composer, "plan", plan));
        const Plan* const coming = composer->composer.coming_plan();
        *plan = nullptr;
        if (coming != nullptr) give(*coming, plan);
        return {};
    });
}

DarkroomResult darkroom_composer_current_plan(DarkroomComposer composer, DarkroomPlan* plan) {
    return call("darkroom_composer_current_plan", [&]() -> Result<> {
        DARKROOM_TRY(needs("composer", composer, "plan", plan));
        const Plan* const now = composer->composer.current_plan();
        if (now == nullptr) return user_error("the composer has no plan: compile it");
        give(*now, plan);
        return {};
    });
}

DarkroomResult darkroom_composer_plan(DarkroomComposer composer, const DarkroomCompileDesc* given, DarkroomPlan* plan) {
    return call("darkroom_composer_plan", [&]() -> Result<> {
        DARKROOM_TRY(needs("composer", composer, "desc", given, "plan", plan));
        DARKROOM_TRY_VALUE(const auto desc, compile_desc_of(given));
        DARKROOM_TRY_VALUE(auto made, composer->composer.plan(desc));
        give(std::move(made), plan);
        return {};
    });
}

DarkroomResult darkroom_composer_statistics(DarkroomComposer composer, const DarkroomCompileDesc* given,
                                            DarkroomKernelValue* values, uint32_t* count) {
    return call("darkroom_composer_statistics", [&]() -> Result<> {
        DARKROOM_TRY(needs("composer", composer, "desc", given, "count", count));
        DARKROOM_TRY_VALUE(const auto desc, compile_desc_of(given));
        DARKROOM_TRY_VALUE(const auto kernels, composer->composer.statistics(desc));
        std::vector<std::string> texts;
        for (const KernelStatistics& kernel : kernels) {
            texts.push_back(kernel.name);
            for (const KernelStatistics::Value& value : kernel.values) texts.push_back(value.name);
        }
        composer->texts = std::move(texts);
        std::size_t row = 0, text = 0;
        for (const KernelStatistics& kernel : kernels) {
            DarkroomKernelValue out{};
            out.subgroup = kernel.subgroup;
            std::ranges::copy(kernel.workgroup, out.workgroup);
            out.kernel = composer->texts[text++].c_str();
            for (const KernelStatistics::Value& value : kernel.values) {
                out.name = composer->texts[text++].c_str();
                out.value = value.value;
                if (values != nullptr && row < *count) DARKROOM_TRY(write_at(values, row, out, "DarkroomKernelValue"));
                ++row;
            }
        }
        *count = static_cast<std::uint32_t>(row);
        return {};
    });
}

const char* darkroom_plan_text(DarkroomPlan plan) {
    return call_for<const char*>("darkroom_plan_text", nullptr, [&]() -> const char* {
        if (plan == nullptr) return nullptr;
        if (plan->text.empty()) plan->text = plan->plan.text();
        return plan->text.c_str();
    });
}

const char* darkroom_plan_json(DarkroomPlan plan) {
    return call_for<const char*>("darkroom_plan_json", nullptr, [&]() -> const char* {
        if (plan == nullptr) return nullptr;
        if (plan->json.empty()) plan->json = plan->plan.json();
        return plan->json.c_str();
    });
}

uint64_t darkroom_plan_bytes_read(DarkroomPlan plan) { return plan == nullptr ? 0 : plan->plan.bytes_read(); }
uint64_t darkroom_plan_bytes_written(DarkroomPlan plan) { return plan == nullptr ? 0 : plan->plan.bytes_written(); }
void darkroom_plan_destroy(DarkroomPlan plan) { delete plan; }

DarkroomResult darkroom_composer_record(DarkroomComposer composer, VkCommandBuffer commands,
                                        const DarkroomFrame* given) {
    return call("darkroom_composer_record", [&]() -> Result<> {
        DARKROOM_TRY(needs("composer", composer, "commands", commands, "frame", given));
        DARKROOM_TRY_VALUE(const auto frame, frame_of(given, *composer));
        return composer->composer.record(commands, frame);
    });
}

DarkroomResult darkroom_composer_abandon(DarkroomComposer composer) {
    return call("darkroom_composer_abandon", [&]() -> Result<> {
        DARKROOM_TRY(needs("composer", composer));
        return composer->composer.abandon();
    });
}

DarkroomResult darkroom_composer_watch_state(DarkroomComposer composer, uint32_t id, DarkroomWatchState* state) {
    return call("darkroom_composer_watch_state", [&]() -> Result<> {
        DARKROOM_TRY(needs("composer", composer, "state", state));
        *state = static_cast<DarkroomWatchState>(composer->composer.watch_state(id));
        return {};
    });
}

DarkroomResult darkroom_composer_wait_for_kernels(DarkroomComposer composer) {
    return call("darkroom_composer_wait_for_kernels", [&]() -> Result<> {
        DARKROOM_TRY(needs("composer", composer));
        composer->composer.wait_for_kernels();
        return {};
    });
}

DarkroomResult darkroom_composer_times(DarkroomComposer composer, uint64_t* frame_index, DarkroomPassTime* passes,
                                       uint32_t* count) {
    return call("darkroom_composer_times", [&]() -> Result<> {
        DARKROOM_TRY(needs("composer", composer, "count", count));
        const RecordingTimes times = composer->composer.times();
        composer->texts.clear();
        for (const PassTime& pass : times.passes) composer->texts.emplace_back(pass.name);
        for (std::size_t i = 0; i < times.passes.size() && passes != nullptr && i < *count; ++i) {
            DarkroomPassTime out{};
            out.name = composer->texts[i].c_str();
            out.milliseconds = times.passes[i].milliseconds;
            DARKROOM_TRY(write_at(passes, i, out, "DarkroomPassTime"));
        }
        *count = static_cast<std::uint32_t>(times.passes.size());
        if (frame_index != nullptr) *frame_index = times.frame_index;
        return {};
    });
}

DarkroomResult darkroom_composer_value(DarkroomComposer composer, const char* name, uint32_t view,
                                       uint64_t* frame_index, float* numbers, uint32_t* count) {
    return call("darkroom_composer_value", [&]() -> Result<> {
        DARKROOM_TRY(needs("composer", composer, "name", name, "count", count));
        const ValueReading reading = composer->composer.value(name, view);
        write_all(reading.numbers, numbers, count);
        if (frame_index != nullptr) *frame_index = reading.frame_index;
        return {};
    });
}

DarkroomResult darkroom_composer_record_microseconds(DarkroomComposer composer, double* microseconds) {
    return call("darkroom_composer_record_microseconds", [&]() -> Result<> {
        DARKROOM_TRY(needs("composer", composer, "microseconds", microseconds));
        *microseconds = composer->composer.record_microseconds();
        return {};
    });
}

DarkroomResult darkroom_composer_rebind(DarkroomComposer composer, DarkroomDevice device, DarkroomPlan* plan) {
    return call("darkroom_composer_rebind", [&]() -> Result<> {
        DARKROOM_TRY(needs("composer", composer, "device", device));
        DARKROOM_TRY_VALUE(auto made, composer->composer.rebind(device->device));
        give(std::move(made), plan);
        return {};
    });
}

void darkroom_composer_jitter(uint64_t frame_index, float scale, float jitter[2]) {
    if (jitter != nullptr) std::ranges::copy(Composer::jitter(frame_index, scale), jitter);
}

float darkroom_composer_mip_bias(float scale) { return Composer::mip_bias(scale); }

void darkroom_jittered(const float projection[16], const float jitter[2], VkExtent2D extent, VkBool32 is_y_up,
                       float out[16]) {
    if (projection == nullptr || jitter == nullptr || out == nullptr) return;
    Matrix matrix;
    std::copy_n(projection, matrix.size(), matrix.begin());
    std::ranges::copy(jittered(matrix, {jitter[0], jitter[1]}, extent, is_y_up == 0), out);
}

DarkroomResult darkroom_check_temporal(const DarkroomCamera* given, VkExtent2D extent, const float* depth,
                                       const float* velocity, const char** text) {
    return call("darkroom_check_temporal", [&]() -> Result<> {
        DARKROOM_TRY(needs("camera", given, "depth", depth, "velocity", velocity, "text", text));
        DARKROOM_TRY_VALUE(const auto camera, camera_of(given));
        const std::size_t pixels = std::size_t{extent.width} * extent.height;
        thread_local std::string lines;
        lines.clear();
        for (const std::string& line : check_temporal(
                 {.camera = camera, .extent = extent, .depth = {depth, pixels}, .velocity = {velocity, 2 * pixels}}))
            lines += line + "\n";
        *text = lines.c_str();
        return {};
    });
}
