// SPDX-License-Identifier: MIT
#include "compare_files.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/text/param_text.hpp"
#include "image/frame/layer_file.hpp"
#include "programs/darkroom/run/report.hpp"

namespace app {

using darkroom::FileLayer;
using darkroom::LayerFile;
using darkroom::printable;
using darkroom::Result;
using darkroom::user_error;

namespace {

darkroom::NonFinite sum(darkroom::NonFinite a, const std::optional<darkroom::NonFinite>& b) {
    if (!b) return a;
    return {a.nan + b->nan, a.infinite + b->infinite};
}

class FileComparison {
  public:
    FileComparison(const CompareRequest& request, LayerFile reference, LayerFile test)
        : request_(request), files_{std::move(reference), std::move(test)} {}

    Result<ComparedFiles> run(const std::filesystem::path& reference, const std::filesystem::path& test,
                              std::optional<ComparedColor>* color) {
        out_.reference = reference.string();
        out_.test = test.string();
        for (const auto& [file, name] : {std::pair(&files_[0], &out_.reference), std::pair(&files_[1], &out_.test)})
            if (const std::string text = file->decoder().left_out(); !text.empty())
                warn(fmt::format("{}: {}", printable(*name), text));
        color_ = color;
        for (const std::string& name : request_.has_all_layers ? all_layers() : request_.layers)
            DARKROOM_TRY(add(name));
        judge();
        return std::move(out_);
    }

  private:
    [[nodiscard]] std::string both() const {
        return fmt::format("{} and {}", printable(out_.reference), printable(out_.test));
    }

    // Of both files; one that is in one of them alone is a difference, as a file of one folder alone is.
    std::vector<std::string> all_layers() {
        std::vector<std::string> common;
        for (std::size_t i = 0; i < 2; ++i)
            for (const FileLayer& layer : files_[i].layers()) {
                const auto others = files_[1 - i].layers();
                if (std::ranges::find(others, layer.name, &FileLayer::name) == others.end())
                    out_.failures.push_back(fmt::format("{}: only the {} has it", shown(layer.name),
                                                        i == 0 ? "reference" : "picture under test"));
                else if (i == 0)
                    common.push_back(layer.name);
            }
        return common;
    }

    Result<> add(const std::string& name) {
        std::array<FileLayer, 2> layers;
        for (std::size_t i = 0; i < 2; ++i) {
            DARKROOM_TRY_VALUE(FileLayer found, files_[i].find(name));
            layers[i] = std::move(found);
        }
        const auto has_color = [&](std::size_t i) {
            return layers[i].name == "color" && files_[i].of_kind(layers[i], true).channels.empty();
        };
        if (has_color(0) && has_color(1)) return add_color(layers);
        for (const bool is_wide_integer : {false, true}) {
            const std::array of_kind{files_[0].of_kind(layers[0], is_wide_integer),
                                     files_[1].of_kind(layers[1], is_wide_integer)};
            if (!of_kind[0].channels.empty() || !of_kind[1].channels.empty())
                DARKROOM_TRY(add_numbers(of_kind, is_wide_integer));
        }
        return {};
    }

    Result<> add_color(const std::array<FileLayer, 2>& layers) {
        DARKROOM_TRY_VALUE(darkroom::ComparablePicture a, darkroom::read_comparable(files_[0]));
        DARKROOM_TRY_VALUE(darkroom::ComparablePicture b, darkroom::read_comparable(files_[1]));
        if (a.encoding != b.encoding)
            return user_error(fmt::format(
                "{}: one is encoded for a display and the other holds linear floats, they cannot be compared", both()));
        // What says nothing is sRGB.
        if (a.coding.value_or(darkroom::ColorCoding{}) != b.coding.value_or(darkroom::ColorCoding{})) {
            const auto said = [](const darkroom::ComparablePicture& picture) {
                return picture.color_said.empty() ? "nothing, so sRGB" : picture.color_said;
            };
            warn(fmt::format("{}: their code values are of two color spaces ({}; {}) and are compared as they are",
                             both(), said(a), said(b)));
        }
        Result<darkroom::Comparison> result = darkroom::compare(a.picture, b.picture, {.encoding = a.encoding});
        if (!result)
            return darkroom::failure({result.error().fault, fmt::format("{}: {}", both(), result.error().text)});
        out_.layers.push_back(
            {.name = layers[0].name,
             .channels = {"red", "green", "blue"},
             .errors = *result,
             .alpha = result->alpha,
             .flip = ComparedLayer::Flip{a.encoding == darkroom::PictureEncoding::SceneLinear, result->flip_mean,
                                         result->flip_weighted_median, result->flip_max}});
        if (color_ != nullptr) *color_ = ComparedColor{std::move(a), std::move(b), std::move(*result)};
        return {};
    }

    /// Of a kind: numbers, or 32-bit integers, which are compared in all their bits.
    Result<> add_numbers(const std::array<FileLayer, 2>& layers, bool is_wide_integer) {
        if (layers[0].channels.empty() || layers[1].channels.empty())
            return user_error(
                fmt::format("{}: only one of them has 32-bit integers in the layer {}", both(), shown(layers[0].name)));
        DARKROOM_TRY_VALUE(darkroom::LayerSamples a, files_[0].read(layers[0]));
        DARKROOM_TRY_VALUE(darkroom::LayerSamples b, files_[1].read(layers[1]));
        if (a.width != b.width || a.height != b.height || a.channels != b.channels)
            return user_error(fmt::format(
                "{}: the layers {} differ in size: {}x{} with {} channels and {}x{} with {}; "
                "they must be the same",
                both(), shown(layers[0].name), a.width, a.height, a.channels, b.width, b.height, b.channels));
        const darkroom::SampleLayout layout{.width = a.width, .stride = a.channels, .count = a.channels};
        out_.layers.push_back({.name = layers[0].name,
                               .channels = files_[0].channel_names(layers[0]),
                               .errors = is_wide_integer ? darkroom::measure(a.integers, b.integers, layout)
                                                         : darkroom::measure(a.values, b.values, layout),
                               .is_integer = is_wide_integer});
        return {};
    }

    void judge() {
        const auto say = [&](const ComparedLayer& layer, std::string text) {
            const bool is_plain = out_.layers.size() == 1;
            out_.failures.push_back(is_plain ? std::move(text) : fmt::format("{}: {}", shown(layer.name), text));
        };
        const Thresholds& most = request_.thresholds;
        for (const ComparedLayer& layer : out_.layers) {
            if (const std::uint64_t count = layer.non_finite_differences(); count > 0)
                say(layer, fmt::format("NaN or infinity differs in {} sample{}", count, count == 1 ? "" : "s"));
            if (most.max && layer.max_error() > *most.max)
                say(layer, fmt::format("max error {:.6g} is above {:g}", layer.max_error(), *most.max));
            if (most.psnr && layer.errors.psnr < *most.psnr)
                say(layer, fmt::format("PSNR {:.3f} dB is below {:g} dB", layer.errors.psnr, *most.psnr));
            if (most.flip && layer.flip && layer.flip->mean > *most.flip)
                say(layer, fmt::format("mean FLIP {:.6f} is above {:g}", layer.flip->mean, *most.flip));
        }
    }

    [[nodiscard]] static std::string shown(const std::string& name) { return darkroom::one_printable_line(name); }

    const CompareRequest& request_;
    std::array<LayerFile, 2> files_;
    ComparedFiles out_;
    std::optional<ComparedColor>* color_ = nullptr;
};

}  // namespace

std::uint64_t ComparedLayer::non_finite_differences() const {
    return errors.non_finite_differences + (alpha ? alpha->non_finite_differences : 0);
}

darkroom::NonFinite ComparedLayer::reference_counts() const {
    return sum(errors.reference, alpha ? std::optional(alpha->reference) : std::nullopt);
}

darkroom::NonFinite ComparedLayer::test_counts() const {
    return sum(errors.test, alpha ? std::optional(alpha->test) : std::nullopt);
}

double ComparedLayer::max_error() const { return std::max(errors.max_error, alpha ? alpha->max_error : 0.0); }

Result<ComparedFiles> compare_files(const std::filesystem::path& reference, const std::filesystem::path& test,
                                    const CompareRequest& request, std::optional<ComparedColor>* color) {
    DARKROOM_TRY_VALUE(LayerFile a, LayerFile::open(reference));
    DARKROOM_TRY_VALUE(LayerFile b, LayerFile::open(test));
    return FileComparison(request, std::move(a), std::move(b)).run(reference, test, color);
}

}  // namespace app
