// SPDX-License-Identifier: MIT
// Compiles every kernel for GPUs that need not be there, by RADV's null devices, and holds what they cost against the
// tables of proof/bench/results/compilers.
//     darkroom_compilers check TABLES CACHE FAMILY    0; 1, with a line a finding; or 77: there is no RADV
//     darkroom_compilers renew TABLES CACHE FAMILY... writes the tables anew
// TABLES and CACHE are folders; FAMILY is what RADV_FORCE_FAMILY takes, such as navi21.
#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <darkroom/device.hpp>
#include <mutex>
#include <span>
#include <unordered_set>

#include "compose/stack/stack_program.hpp"
#include "core/files.hpp"
#include "core/thread/parallel.hpp"
#include "develop/cost/kernel_cost.hpp"
#include "every_kernel.hpp"
#include "gpu/device/context.hpp"

namespace {

using namespace darkroom;
namespace fs = std::filesystem;

constexpr int exit_skipped = 77;  // as tests/CMakeLists.txt has it for CTest

struct Job {
    NamedKernel kernel;
    gpu::Stage stage = gpu::Stage::Compute;

    [[nodiscard]] std::string name() const {
        return fmt::format("{}, {}, {}", kernel.name, stage == gpu::Stage::Compute ? "compute" : "raster",
                           kernel.is_lean ? "lean" : "complete");
    }
};

/// In both stages, equal ones once.
Result<std::vector<Job>> jobs_on(const gpu::Context& context) {
    std::vector<Job> out;
    std::unordered_set<std::string> texts;
    for (const auto& [stage, wanted] :
         {std::pair(gpu::Stage::Compute, KernelStage::Compute), std::pair(gpu::Stage::Raster, KernelStage::Raster)}) {
        DARKROOM_TRY_VALUE(auto kernels, every_kernel(compose::planner_traits(context, wanted), true));
        for (NamedKernel& kernel : kernels) {
            if (!gpu::usable(context, kernel.spec, stage)) continue;
            if (texts.insert(gpu::kernel_source(kernel.spec, stage)).second) out.push_back({std::move(kernel), stage});
        }
    }
    return out;
}

Result<KernelRow> row_of(gpu::Context& context, const Job& job, Architecture architecture) {
    DARKROOM_TRY_VALUE(const auto kernel, gpu::Kernel::create(context, job.kernel.spec, job.stage));
    DARKROOM_TRY_VALUE(const auto statistics, kernel->statistics());
    const auto cost = kernel_cost(statistics, architecture);
    if (!cost) return machine_error(fmt::format("{}: the driver shows no machine code", job.name()));
    const auto value = [&](std::string_view name) { return statistics.value(name); };
    return KernelRow{.vgprs = value("VGPRs"),
                     .waves = occupancy(statistics, architecture),
                     .instructions = value("Instructions"),
                     .alu = cost->alu,
                     .texture = cost->texture,
                     .lds = cost->lds,
                     .spilled = value("Spilled VGPRs") + value("Spilled SGPRs") + value("Scratch size")};
}

Result<KernelTable> table_on(const Device& device, std::size_t threads) {
    const Architecture architecture = architecture_of(amd_family(device.info().name));
    DARKROOM_TRY_VALUE(const auto jobs, jobs_on(device.context()));
    KernelTable out{.driver = device.info().driver, .rows = {}};
    std::mutex mutex;
    Result<> failed{};
    parallel_for(jobs.size(), threads, [&](std::size_t i) {
        auto row = row_of(device.context(), jobs[i], architecture);
        const std::scoped_lock lock(mutex);
        if (row)
            out.rows.emplace(jobs[i].name(), *row);
        else if (failed)
            failed = failure(std::move(row));
    });
    if (!failed) return failure(std::move(failed));
    return out;
}

Result<Device> null_device(const std::string& family, const fs::path& cache) {
    // What makes RADV say that it has such a GPU.
    setenv("RADV_FORCE_FAMILY", family.c_str(), 1);
    return Device::create({.select = "RADV " + family, .compiles_only = true, .cache_folder = cache});
}

int check(const std::string& family, const fs::path& folder, const fs::path& cache) {
    const Result<Device> device = null_device(family, cache);
    if (!device) {
        fmt::print("skipped: {}\n", device.error().text);
        return exit_skipped;
    }
    const auto before = KernelTable::read(folder / (family + ".txt"));
    const auto now = table_on(*device, 1);
    if (!before || !now) {
        fmt::print("{}\n", (before ? now : before).error().text);
        return EXIT_FAILURE;
    }
    const std::vector<std::string> found = findings(*before, *now);
    for (const std::string& text : found) fmt::print("{}: {}\n", family, text);
    fmt::print("{}: {} kernels, {} findings\n", family, now->rows.size(), found.size());
    if (before->driver != now->driver)
        fmt::print("costs were not compared: the table is of {}, the driver is {}\n", before->driver, now->driver);
    if (found.empty()) return EXIT_SUCCESS;
    fmt::print("if this is wanted, renew the tables: cmake --build build --target renew_kernel_costs\n");
    return EXIT_FAILURE;
}

int renew(std::span<const char* const> families, const fs::path& folder, const fs::path& cache) {
    for (const char* const family : families) {
        const Result<Device> device = null_device(family, cache);
        const Result<KernelTable> table = device ? table_on(*device, 0) : failure(device.error());
        const fs::path file = folder / fmt::format("{}.txt", family);
        const std::string text = table ? table->text() : std::string();
        const Result<> written = table ? write_file(file, std::as_bytes(std::span(text))) : failure(table.error());
        if (!written) {
            fmt::print("{}: {}\n", family, written.error().text);
            return EXIT_FAILURE;
        }
        fmt::print("{}: {} kernels\n", file.string(), table->rows.size());
    }
    return EXIT_SUCCESS;
}

}  // namespace

int main(int argc, char** argv) {
    const std::span<const char* const> arguments(argv, static_cast<std::size_t>(argc));
    const std::string_view mode = argc > 4 ? arguments[1] : "";
    if (mode == "renew") return renew(arguments.subspan(4), arguments[2], arguments[3]);
    if (mode == "check" && argc == 5) return check(arguments[4], arguments[2], arguments[3]);
    fmt::print(stderr, "darkroom_compilers check TABLES CACHE FAMILY, or renew TABLES CACHE FAMILY...\n");
    return EXIT_FAILURE;
}
