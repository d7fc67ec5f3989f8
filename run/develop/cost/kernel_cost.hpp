// SPDX-License-Identifier: MIT
#pragma once
// What a kernel costs on AMD's GPUs, counted from its machine code, and on which chip that takes how long. It compares
// kernels, and knows no latency and no cache. docs/kernel_costs.md says what is counted how.

#include <cstdint>
#include <darkroom/kernel_statistics.hpp>
#include <darkroom/result.hpp>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace darkroom {

/// Of the SIMDs, which is what the units' cycles depend on: 16 lanes of GCN, 32 of RDNA.
enum class Architecture : std::uint8_t { Gcn, Rdna };

/// A GPU that can be bought, and what Vulkan does not tell of it. Figures are those of AMD's data sheets, the clock is
/// the boost clock.
struct Chip {
    std::string_view name;
    std::string_view family;  ///< as RADV names it
    Architecture architecture = Architecture::Rdna;
    std::uint32_t simds = 0;
    double gigahertz = 0;
    double gigabytes_per_second = 0;  ///< of its memory
};
[[nodiscard]] std::span<const Chip> chips();
/// "NAVI21" of "Null hardware (RADV NAVI21)" and "AMD Radeon RX 6800 XT (RADV NAVI21)"; empty: another driver's device.
[[nodiscard]] std::string_view amd_family(std::string_view device_name);
/// Of any family, listed in chips() or not.
[[nodiscard]] Architecture architecture_of(std::string_view family);

/// Cycles are those of a SIMD for 64 threads.
struct KernelCost {
    double alu = 0;  ///< vector, transcendental or scalar instructions, whichever take longest
    double texture = 0;
    double lds = 0;
    struct Loop {
        double trips = 0;
        bool is_known = false;  ///< else a guess, that of the driver's compiler
    };
    std::vector<Loop> loops;  ///< in the order of the machine code; an inner one counts within each round of the outer

    /// The units work side by side: what takes longest.
    [[nodiscard]] double cycles() const;
    /// "ALU", "texture" or "LDS": which that is.
    [[nodiscard]] std::string_view bound() const;
};
/// Nothing: the machine code is not there, or not AMD's. `trips`: of the first loops, where the caller knows better.
[[nodiscard]] std::optional<KernelCost> kernel_cost(const KernelStatistics& statistics, Architecture architecture,
                                                    std::span<const double> trips = {});

/// Of 64 threads each, that a SIMD holds at once.
[[nodiscard]] double occupancy(const KernelStatistics& statistics, Architecture architecture);

/// Milliseconds for `pixels` threads that move `bytes`: that of the SIMDs or that of the memory, whichever is longer.
[[nodiscard]] double milliseconds(const KernelCost& cost, double pixels, double bytes, const Chip& chip);

// What kernels cost on a GPU, as a text file that people read and a later build is held against.

struct KernelRow {
    double vgprs = 0, waves = 0, instructions = 0, alu = 0, texture = 0, lds = 0;
    double spilled = 0;  ///< registers, and bytes of scratch memory
    [[nodiscard]] double cycles() const;
};

struct KernelTable {
    std::string driver;
    /// By name, stage and form: "bloom: bloom.prefilter, compute, lean".
    std::map<std::string, KernelRow> rows;

    [[nodiscard]] std::string text() const;
    /// Errors: a file that cannot be read, a line that is none of a table.
    [[nodiscard]] static Result<KernelTable> read(const std::filesystem::path& path);
};

/// A sentence for each kernel that spills, costs a tenth more than in `before`, or is not in it. Costs are compared
/// where the driver is the same.
[[nodiscard]] std::vector<std::string> findings(const KernelTable& before, const KernelTable& now);

}  // namespace darkroom
