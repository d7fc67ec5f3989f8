// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <exception>
#include <optional>
#include <vector>

#include "core/program_module.hpp"
#include "image/table/color_chain.hpp"
#include "ocio/config_chain.hpp"
#include "ocio/ocio_support.hpp"
#include "ocio/references.hpp"

namespace darkroom {
namespace {

using Color = std::array<float, 3>;

constexpr std::uint32_t usual_cube_size = 65, usual_shaper_size = 4096, max_shaper_size = 65536;

/// Of a step that scales and shifts every channel by itself: out = in * scale + offset.
struct Affine {
    std::array<double, 3> scale{1, 1, 1}, offset{};

    [[nodiscard]] Affine then(const Affine& next) const {
        Affine out;
        for (std::size_t i = 0; i < 3; ++i) {
            out.scale[i] = scale[i] * next.scale[i];
            out.offset[i] = offset[i] * next.scale[i] + next.offset[i];
        }
        return out;
    }
    /// The input that becomes `value`.
    [[nodiscard]] float input(std::size_t channel, double value) const {
        return static_cast<float>((value - offset[channel]) / scale[channel]);
    }
};

std::optional<Affine> affine_of(const ocio::ConstTransformRcPtr& step) {
    const auto matrix = ocio::DynamicPtrCast<const ocio::MatrixTransform>(step);
    if (!matrix || matrix->getDirection() != ocio::TRANSFORM_DIR_FORWARD) return std::nullopt;
    std::array<double, 16> values{};
    std::array<double, 4> offsets{};
    matrix->getMatrix(values.data());
    matrix->getOffset(offsets.data());
    Affine out;
    for (std::size_t row = 0; row < 3; ++row) {
        for (std::size_t column = 0; column < 3; ++column)
            if (row != column && values[row * 4 + column] != 0) return std::nullopt;
        if (!(values[row * 5] > 0)) return std::nullopt;
        out.scale[row] = values[row * 5];
        out.offset[row] = offsets[row];
    }
    return out;
}

/// A 1D table, forward.
ocio::ConstLut1DTransformRcPtr lut1d_of(const ocio::ConstTransformRcPtr& step) {
    const auto lut = ocio::DynamicPtrCast<const ocio::Lut1DTransform>(step);
    return lut && lut->getDirection() == ocio::TRANSFORM_DIR_FORWARD ? lut : nullptr;
}

/// What is clamped at both ends, and how it is scaled between them.
struct Clamp {
    double min = 0, max = 0;
    Affine affine;
};
std::optional<Clamp> clamp_of(const ocio::ConstTransformRcPtr& step) {
    const auto range = ocio::DynamicPtrCast<const ocio::RangeTransform>(step);
    if (!range || range->getDirection() != ocio::TRANSFORM_DIR_FORWARD || range->getStyle() != ocio::RANGE_CLAMP ||
        !range->hasMinInValue() || !range->hasMaxInValue() || !(range->getMinInValue() < range->getMaxInValue()))
        return std::nullopt;
    Clamp out{.min = range->getMinInValue(), .max = range->getMaxInValue()};
    const double scale = (range->getMaxOutValue() - range->getMinOutValue()) / (out.max - out.min);
    if (!(scale > 0)) return std::nullopt;
    out.affine.scale.fill(scale);
    out.affine.offset.fill(range->getMinOutValue() - out.min * scale);
    return out;
}

class Chain final : public ColorChain {
  public:
    explicit Chain(const std::filesystem::path& path) : path_(path), config_(ocio::Config::CreateRaw()) {
        // It remembers files by their names, and what is behind a name may have changed.
        ocio::ClearAllCaches();
        // What the table names is looked for beside it (ocio/references.hpp).
        const std::filesystem::path whole = std::filesystem::absolute(path).lexically_normal();
        const ocio::ConfigRcPtr config = config_->createEditableCopy();
        config->setWorkingDir(whole.parent_path().c_str());
        config_ = config;
        const ocio::FileTransformRcPtr file = ocio::FileTransform::Create();
        file->setSrc(whole.c_str());
        file->setInterpolation(ocio::INTERP_TETRAHEDRAL);
        whole_ = config_->getProcessor(file);
        const ocio::GroupTransformRcPtr group = whole_->createGroupTransform();
        for (int i = 0; i < group->getNumTransforms(); ++i) steps_.push_back(group->getTransform(i));
    }

    void apply(std::span<Color> colors) const override { run(whole_, colors); }

    Result<ColorTable> sampled() const override {
        try {
            return sample();
        } catch (const std::exception& exception) {
            return failure(error_of(exception, path_));
        }
    }

  private:
    using Steps = std::span<const ocio::ConstTransformRcPtr>;

    [[nodiscard]] ocio::ConstProcessorRcPtr processor_of(Steps steps) const {
        const ocio::GroupTransformRcPtr group = ocio::GroupTransform::Create();
        for (const ocio::ConstTransformRcPtr& step : steps) group->appendTransform(step->createEditableCopy());
        return config_->getProcessor(group);
    }

    // The steps up to the first that mixes channels become the shaper, the others the cube.
    [[nodiscard]] ColorTable sample() const {
        const Steps all(steps_);
        std::size_t split = 0;
        while (split < all.size() && !processor_of(all.subspan(split, 1))->hasChannelCrosstalk()) ++split;
        const Steps before = all.first(split), behind = all.subspan(split);
        ColorTable table;
        const auto lut3d = behind.empty() ? nullptr : ocio::DynamicPtrCast<const ocio::Lut3DTransform>(behind.front());
        std::size_t scales = 0;
        auto [min, max, length] = inputs_of(before, scales, lut3d != nullptr);
        if (behind.empty() || scales < before.size() || (!before.empty() && !lut3d)) {
            // One range for all channels where a cube follows, which is what .cube can say.
            if (!behind.empty()) {
                min.fill(*std::ranges::min_element(min));
                max.fill(*std::ranges::max_element(max));
            }
            table.shaper_min = min;
            table.shaper_max = max;
            sample_shaper(table, before, length);
            min.fill(lut3d ? 0.0f : *std::ranges::min_element(table.shaper));
            max.fill(lut3d ? 1.0f : *std::ranges::max_element(table.shaper));
            if (!(min[0] < max[0])) max.fill(min[0] + 1);
        }
        if (behind.empty()) return table;
        table.min = min;
        table.max = max;
        table.size = cube_size(behind);
        // Scales without a shaper are in the cube's inputs.
        sample_cube(table, table.shaper_size > 0 ? behind : all);
        return table;
    }

    struct Inputs {
        Color min{}, max{};
        std::uint32_t length = usual_shaper_size;  ///< of a 1D table over them
    };

    /// What the steps take before they clamp it. `scales`: those before the first that is neither a scale nor a clamp.
    [[nodiscard]] Inputs inputs_of(Steps steps, std::size_t& scales, bool has_cube) const {
        Affine affine;
        Inputs clamped;
        bool is_clamped = false;
        for (; scales < steps.size(); ++scales) {
            const std::optional<Clamp> clamp = clamp_of(steps[scales]);
            for (std::size_t i = 0; clamp && i < 3; ++i) {
                const float low = affine.input(i, clamp->min), high = affine.input(i, clamp->max);
                clamped.min[i] = is_clamped ? std::max(clamped.min[i], low) : low;
                clamped.max[i] = is_clamped ? std::min(clamped.max[i], high) : high;
            }
            is_clamped = is_clamped || clamp;
            const std::optional<Affine> next = clamp ? clamp->affine : affine_of(steps[scales]);
            if (!next) break;
            affine = affine.then(*next);
        }
        const auto lut = scales < steps.size() ? lut1d_of(steps[scales]) : nullptr;
        const bool is_of_halves = lut && lut->getInputHalfDomain();
        const auto [least, most] = is_of_halves ? inputs_of_halves(steps[scales]) : std::array<double, 2>{0, 1};
        Inputs out;
        if (lut) out.length = std::clamp(static_cast<std::uint32_t>(lut->getLength()), 2U, max_shaper_size);
        for (std::size_t i = 0; i < 3; ++i) {
            out.min[i] = affine.input(i, least);
            out.max[i] = affine.input(i, most);
            if (!is_clamped) continue;
            // Steps without a table go as far as they are clamped.
            const bool has_table = lut || (scales == steps.size() && has_cube);
            const float low = std::max(out.min[i], clamped.min[i]), high = std::min(out.max[i], clamped.max[i]);
            // Between the entries of a table that is cut there are more of ours.
            const auto is_near = [&](float a, float b) { return std::abs(a - b) <= 1e-5f * (high - low); };
            if (!is_near(low, out.min[i]) || !is_near(high, out.max[i]))
                out.length = std::max(out.length, usual_shaper_size);
            out.min[i] = has_table && low < high ? low : clamped.min[i];
            out.max[i] = has_table && low < high ? high : clamped.max[i];
        }
        return out;
    }

    /// A table with an entry for every half reaches to 65504, and ours has even steps: the widest inputs in which what
    /// is between two of them is near, within a two-thousandth.
    [[nodiscard]] std::array<double, 2> inputs_of_halves(const ocio::ConstTransformRcPtr& step) const {
        const ocio::ConstProcessorRcPtr curve = processor_of({&step, 1});
        for (double most = 65504; most > 1; most /= 2) {
            std::vector<Color> ends{Color{}, Color{}};
            ends[0].fill(static_cast<float>(-most));
            run(curve, ends);
            const double least = ends[0] == ends[1] ? 0 : -most, size = (most - least) / (max_shaper_size - 1);
            // Two entries and what is between them, next to 0 and ever less often farther off.
            const double zero = std::floor(-least / size);
            std::vector<Color> colors;
            for (double entry = 0; entry * size < most; entry = std::max(entry + 1, std::floor(entry * 1.01)))
                for (const double from : {zero + entry, zero - 1 - entry})
                    for (const double part : {0.0, 0.25, 0.5, 0.75, 1.0})
                        if (from >= 0) colors.emplace_back().fill(static_cast<float>(least + (from + part) * size));
            run(curve, colors);
            bool is_near = true;
            for (std::size_t n = 0; n + 5 <= colors.size(); n += 5)
                for (std::size_t i = 0; i < 3; ++i)
                    for (std::size_t k = 1; k < 4; ++k) {
                        const float part = static_cast<float>(k) / 4;
                        const float even = colors[n][i] * (1 - part) + colors[n + 4][i] * part;
                        is_near = is_near && std::abs(even - colors[n + k][i]) <= 5e-4f;
                    }
            if (is_near) return {least, most};
        }
        return {0, 1};
    }

    void sample_shaper(ColorTable& table, Steps steps, std::uint32_t length) const {
        table.shaper_size = length;
        std::vector<Color> colors(table.shaper_size);
        for (std::uint32_t entry = 0; entry < table.shaper_size; ++entry)
            colors[entry] = input_of(table.shaper_min, table.shaper_max, {entry, entry, entry}, table.shaper_size);
        run(processor_of(steps), colors);
        for (const Color& color : colors) table.shaper.insert(table.shaper.end(), color.begin(), color.end());
    }

    /// Of a cube alone, or with scales behind it, its own; where curves stand behind it, its cells are cut further, and
    /// its entries are among ours.
    [[nodiscard]] static std::uint32_t cube_size(Steps steps) {
        const auto lut = ocio::DynamicPtrCast<const ocio::Lut3DTransform>(steps.front());
        if (!lut || lut->getDirection() != ocio::TRANSFORM_DIR_FORWARD) return usual_cube_size;
        const auto cells = static_cast<std::uint32_t>(lut->getGridSize()) - 1;
        const bool is_linear = std::ranges::all_of(steps.subspan(1), [](const auto& step) {
            return ocio::DynamicPtrCast<const ocio::MatrixTransform>(step) != nullptr;
        });
        if (is_linear) return cells + 1;
        constexpr std::uint32_t most_cells = 128, usual_cells = usual_cube_size - 1;
        std::uint32_t parts = (usual_cells + cells - 1) / cells;
        if (parts == 1 && 2 * cells <= most_cells) parts = 2;
        return cells * parts + 1;
    }

    void sample_cube(ColorTable& table, Steps steps) const {
        std::vector<Color> colors;
        colors.reserve(std::size_t{table.size} * table.size * table.size);
        for (std::uint32_t b = 0; b < table.size; ++b)
            for (std::uint32_t g = 0; g < table.size; ++g)
                for (std::uint32_t r = 0; r < table.size; ++r)
                    colors.push_back(input_of(table.min, table.max, {r, g, b}, table.size));
        run(processor_of(steps), colors);
        table.cube.reserve(colors.size() * 3);
        for (const Color& color : colors) table.cube.insert(table.cube.end(), color.begin(), color.end());
    }

    static Color input_of(const Color& min, const Color& max, const std::array<std::uint32_t, 3>& entry,
                          std::uint32_t count) {
        Color out{};
        for (std::size_t i = 0; i < 3; ++i) {
            const double t = double(entry[i]) / (count - 1.0);
            out[i] = static_cast<float>(double{min[i]} * (1 - t) + double{max[i]} * t);
        }
        return out;
    }

    std::filesystem::path path_;
    ocio::ConstConfigRcPtr config_;
    ocio::ConstProcessorRcPtr whole_;
    std::vector<ocio::ConstTransformRcPtr> steps_;
};

Result<std::unique_ptr<ColorChain>> open(const std::filesystem::path& path) {
    try {
        // What it would tell is told by errors, on one line.
        ocio::SetLoggingLevel(ocio::LOGGING_LEVEL_NONE);
        DARKROOM_TRY(check_references(path));
        return std::make_unique<Chain>(path);
    } catch (const std::exception& exception) {
        return failure(error_of(exception, path));
    }
}

}  // namespace
}  // namespace darkroom

extern "C" DARKROOM_MODULE_EXPORT const darkroom::ColorChains* darkroom_ocio_chains() {
    static const darkroom::ColorChains chains{
        .open = darkroom::open, .from_space = darkroom::chain_from_space, .to_view = darkroom::chain_to_view};
    return &chains;
}
