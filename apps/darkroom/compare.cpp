// SPDX-License-Identifier: MIT
#include "image/compare.hpp"

#include <fmt/format.h>

#include <array>
#include <memory>
#include <optional>

#include "commands.hpp"
#include "core/param_text.hpp"
#include "image/display_picture.hpp"
#include "image/write.hpp"
#include "number_flag.hpp"
#include "outputs.hpp"
#include "report.hpp"

namespace app {

namespace {

using darkroom::Result;

struct Options {
    std::string a, b, diff;
    NumberFlag fail_above{"--fail-above", {.least = 0, .most = 1}};
};

int run(const Options& options) {
    const Result<std::optional<double>> fail_above = options.fail_above.value();
    if (!fail_above) return fail(fail_above.error());
    if (!options.diff.empty()) {
        const std::array<std::filesystem::path, 2> inputs{options.a, options.b};
        if (Result<> done = check_output(options.diff, inputs); !done) return fail(done.error());
        if (const auto kind = darkroom::sample_kind(options.diff, {}); !kind) return fail(kind.error());
    }
    Result<darkroom::ComparablePicture> a = darkroom::read_comparable(options.a);
    if (!a) return fail(a.error());
    Result<darkroom::ComparablePicture> b = darkroom::read_comparable(options.b);
    if (!b) return fail(b.error());
    if (a->encoding != b->encoding)
        return fail_user(fmt::format(
            "{} and {}: one is encoded for a display and the other holds linear floats, they cannot be compared",
            darkroom::printable(options.a), darkroom::printable(options.b)));
    const Result<darkroom::Comparison> result = darkroom::compare(a->picture, b->picture, {.encoding = a->encoding});
    if (!result)
        return fail({result.error().fault, fmt::format("{} and {}: {}", darkroom::printable(options.a),
                                                       darkroom::printable(options.b), result.error().text)});
    if (!options.diff.empty())
        if (Result<> written = darkroom::write_picture(options.diff, result->flip_map); !written)
            return fail(written.error());
    const bool is_display = a->encoding == darkroom::PictureEncoding::Display;
    fmt::print(
        "max error        {:.6g}\nmean error       {:.6g}\nmax alpha error  {:.6g}\nPSNR             {:.3f} dB\n"
        "{} FLIP mean    {:.6f}\n{} FLIP median  {:.6f}\n{} FLIP max     {:.6f}\n",
        result->max_error, result->mean_error, result->max_alpha_error, result->psnr, is_display ? "LDR" : "HDR",
        result->flip_mean, is_display ? "LDR" : "HDR", result->flip_weighted_median, is_display ? "LDR" : "HDR",
        result->flip_max);
    if (!*fail_above || !(result->flip_mean > **fail_above)) return exit_ok;
    return fail_user(fmt::format("{} and {}: mean FLIP {:.6f} is above {:g}", darkroom::printable(options.a),
                                 darkroom::printable(options.b), result->flip_mean, **fail_above));
}

}  // namespace

Command add_compare(CLI::App& program) {
    CLI::App* const command = program.add_subcommand("compare", "Compares two pictures: errors, PSNR and FLIP");
    const auto options = std::make_shared<Options>();
    command->add_option("A", options->a, "The reference")->required();
    command->add_option("B", options->b, "The picture under test")->required();
    command->add_option("--diff", options->diff, "Writes the FLIP errors as a picture")->type_name("OUT.png");
    options->fail_above.add_to(*command, "Exit code 1 if the mean FLIP is above this")->type_name("X");
    return {command, [options] { return run(*options); }};
}

}  // namespace app
