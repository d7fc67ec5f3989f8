// SPDX-License-Identifier: MIT
#include <algorithm>
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

constexpr std::uint32_t usual_cube_size = 65, usual_shaper_size = 4096;

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

/// A 1D table whose entries are spread evenly over [0, 1].
ocio::ConstLut1DTransformRcPtr plain_lut_of(const ocio::ConstTransformRcPtr& step) {
    const auto lut = ocio::DynamicPtrCast<const ocio::Lut1DTransform>(step);
    const bool is_plain = lut && lut->getDirection() == ocio::TRANSFORM_DIR_FORWARD && !lut->getInputHalfDomain();
    return is_plain ? lut : nullptr;
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
        Affine affine;
        std::size_t scales = 0;
        for (; scales < before.size(); ++scales) {
            const std::optional<Affine> next = affine_of(before[scales]);
            if (!next) break;
            affine = affine.then(*next);
        }
        std::array<float, 3> min{}, max{};
        for (std::size_t i = 0; i < 3; ++i) {
            min[i] = affine.input(i, 0);
            max[i] = affine.input(i, 1);
        }
        const auto lut3d = behind.empty() ? nullptr : ocio::DynamicPtrCast<const ocio::Lut3DTransform>(behind.front());
        if (behind.empty() || scales < before.size() || (!before.empty() && !lut3d)) {
            // One range for all channels where a cube follows, which is what .cube can say.
            if (!behind.empty()) {
                min.fill(*std::ranges::min_element(min));
                max.fill(*std::ranges::max_element(max));
            }
            table.shaper_min = min;
            table.shaper_max = max;
            sample_shaper(table, before, scales);
            min.fill(lut3d ? 0.0f : *std::ranges::min_element(table.shaper));
            max.fill(lut3d ? 1.0f : *std::ranges::max_element(table.shaper));
            if (!(min[0] < max[0])) max.fill(min[0] + 1);
        }
        if (behind.empty()) return table;
        table.min = min;
        table.max = max;
        const bool is_table = lut3d && lut3d->getDirection() == ocio::TRANSFORM_DIR_FORWARD;
        table.size = is_table ? static_cast<std::uint32_t>(lut3d->getGridSize()) : usual_cube_size;
        // Scales without a shaper are in the cube's inputs.
        sample_cube(table, table.shaper_size > 0 ? behind : all);
        return table;
    }

    void sample_shaper(ColorTable& table, Steps steps, std::size_t scales) const {
        const auto lut = scales < steps.size() ? plain_lut_of(steps[scales]) : nullptr;
        const auto length = lut ? static_cast<std::uint32_t>(lut->getLength()) : usual_shaper_size;
        table.shaper_size = std::clamp(length, 2U, 65536U);
        std::vector<Color> colors(table.shaper_size);
        for (std::uint32_t entry = 0; entry < table.shaper_size; ++entry)
            colors[entry] = input_of(table.shaper_min, table.shaper_max, {entry, entry, entry}, table.shaper_size);
        run(processor_of(steps), colors);
        for (const Color& color : colors) table.shaper.insert(table.shaper.end(), color.begin(), color.end());
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
