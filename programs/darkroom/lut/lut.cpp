// SPDX-License-Identifier: MIT
// darkroom lut: colour tables in files.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <memory>

#include "core/files.hpp"
#include "core/text/param_text.hpp"
#include "image/table/table_file.hpp"
#include "lut_export.hpp"
#include "programs/darkroom/commands.hpp"
#include "programs/darkroom/flags/look_flags.hpp"
#include "programs/darkroom/run/outputs.hpp"
#include "programs/darkroom/run/report.hpp"

namespace app {

CommandRow info_command();

namespace {

using darkroom::printable;
using darkroom::Result;
using darkroom::user_error;

/// Where a command of `lut` writes its table.
struct Output {
    std::string path;
    bool makes_folder = false;
};

Result<> check(const Output& to, const std::vector<std::filesystem::path>& inputs) {
    const std::filesystem::path path = to.path;
    if (path.extension() != ".cube")
        return user_error(fmt::format("-o {}: tables are written as .cube", printable(to.path)));
    return check_output(path, FileSet(inputs), to.makes_folder ? MissingFolders::Made : MissingFolders::Told);
}

Result<> write(const std::string& path, const darkroom::TableFile& file) {
    const Result<std::string> text = write_cube(file);
    if (!text)
        return failure(darkroom::Error{text.error().fault, fmt::format("{}: {}", printable(path), text.error().text)});
    return darkroom::write_file(path, std::as_bytes(std::span(*text)));
}

CommandFlags add(CommandFlags lut, const char* name, const char* help, Output& out) {
    const CommandFlags command = lut.add_command(name, help);
    command.add_option("-o,--output,--out", out.path, "The table: .cube").type_name("OUT").required();
    command.add_flag("--mkdir", out.makes_folder, "Makes the folder of the table where it is not there");
    return command;
}

Result<> convert(const std::string& from, const Output& to, std::optional<int> bits) {
    DARKROOM_TRY(check(to, {from}));
    DARKROOM_TRY_VALUE(darkroom::FoundTable found, darkroom::read_table_file(from, bits));
    for (const std::string& line : found.warnings) warn(fmt::format("{}: {}", printable(from), line));
    darkroom::TableFile& file = found.file;
    if (file.title.empty()) file.title = std::filesystem::path(from).stem().string();
    if (found.error)
        file.comments.push_back(
            fmt::format("Sampled from {}; largest difference on random colours: {:.6g}", found.format, *found.error));
    return write(to.path, file);
}

Command add_convert(CommandFlags lut) {
    struct Options {
        std::string from;
        Output to;
        NumberFlag bits{"--bits", {.least = 8, .most = 16, .is_whole = true}};
    };
    const auto options = std::make_shared<Options>();
    const CommandFlags command = add(lut, "convert", "Writes a table of any kind as .cube", options->to);
    command
        .add_option("FILE", options->from,
                    fmt::format("A table: {}, a strip or a HaldCLUT", fmt::join(darkroom::table_extensions(), " ")))
        .required();
    options->bits.add_to(command, "Bits of the numbers of a .3dl file, which need not say").type_name("N");
    return {command, [options] {
                std::optional<int> bits;
                if (const Result<> done = options->bits.read_to(bits); !done) return fail(done.error());
                const Result<> done = convert(options->from, options->to, bits);
                return done ? exit_ok : fail(done.error());
            }};
}

Result<> export_to(const Output& to, const LookFlags& flags) {
    DARKROOM_TRY_VALUE(const darkroom::Look look, flags.look());
    DARKROOM_TRY(check(to, flags.input_files()));
    DARKROOM_TRY_VALUE(const ExportedLook exported, export_look(look));
    for (const std::string& line : exported.left_out) warn(fmt::format("left out: {}", line));
    return write(to.path, exported.file);
}

Command add_export(CommandFlags lut, std::span<const darkroom::LookEntry> named) {
    struct Options {
        Output to;
        LookFlags look;
    };
    const auto options = std::make_shared<Options>();
    const CommandFlags command =
        add(lut, "export", "Writes what a look does to colours as a table of 65 steps over 16.5 stops", options->to);
    command.add_option("LOOK", options->look.file, "A look file (TOML), or a scene; default: the flat table")
        .names_look();
    options->look.add_to(command, false, named);
    return {command, [options] {
                const Result<> done = export_to(options->to, options->look);
                return done ? exit_ok : fail(done.error());
            }};
}

}  // namespace

static std::vector<Command> add_lut(CommandFlags program, std::span<const darkroom::LookEntry> named) {
    const CommandFlags lut = program.add_command("lut", "Colour tables: tells of them, converts them, makes them");
    lut.require_command();
    lut.examples(
        "darkroom lut info film.cube\n"
        "darkroom lut convert film.cube -o copy.cube\n"
        "darkroom lut export my.toml -o my.cube");
    const Command info = info_command().add({.program = lut}).front(), convert = add_convert(lut),
                  exported = add_export(lut, named);
    info.flags.examples(
        "darkroom lut info film.cube\n"
        "darkroom lut info film.cube bright.cube\n"
        "darkroom lut info film.cube --json");
    convert.flags.examples(
        "darkroom lut convert film.cube -o copy.cube\n"
        "darkroom lut convert strip.png -o film.cube\n"
        "darkroom lut convert film.spi1d -o film.cube");
    exported.flags.examples(
        "darkroom lut export my.toml -o my.cube\n"
        "darkroom lut export --exposure 2 -o bright.cube\n"
        "darkroom lut export my.toml --no-tonemap -o linear.cube");
    return {info, convert, exported};
}

CommandRow lut_command() {
    return {.names = {"lut"}, .place = 70, .add = [](const CommandHost& host) {
                return add_lut(host.program, host.named);
            }};
}

}  // namespace app
