// SPDX-License-Identifier: MIT
// darkroom man: a manual page for each command, made from what the parser takes.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <span>

#include "core/own_file.hpp"
#include "core/text/param_text.hpp"
#include "help.hpp"
#include "programs/darkroom/commands.hpp"
#include "programs/darkroom/run/report.hpp"

namespace app {

namespace {

using darkroom::Result;

/// Text that troff prints as it is.
std::string literal(std::string_view text) {
    std::string out;
    if (text.starts_with('.') || text.starts_with('\'')) out = "\\&";
    for (const char c : text) {
        if (c == '\\')
            out += "\\e";
        else if (c == '-')
            out += "\\-";
        else
            out += c;
    }
    return out;
}

std::string page_name(const CommandText& command) {
    std::string out = "darkroom";
    if (!command.name.empty()) out += "-" + command.name;
    std::ranges::replace(out, ' ', '-');
    return out;
}

void add_flag(std::string& page, const FlagText& flag) {
    page += fmt::format(".TP\n.B {}\n{}", literal(flag.is_positional ? flag.names.front() : flag.shown()),
                        literal(flag.doc));
    const bool tells_default = !flag.fallback.empty() && flag.doc.find("default") == std::string::npos;
    page += tells_default ? fmt::format(", default {}\n", literal(flag.fallback)) : "\n";
}

std::string page_of(const CommandText& command, std::span<const CommandText> all) {
    std::string title = page_name(command);
    std::ranges::transform(title, title.begin(), [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    std::string page =
        fmt::format(".TH {} 1 \"\" \"darkroom {}\" Darkroom\n.SH NAME\n{} \\- {}\n.SH SYNOPSIS\n.B {}\n", title,
                    DARKROOM_VERSION, literal(page_name(command)), literal(command.doc), literal(command.usage()));
    if (command.name.empty()) {
        page += ".SH COMMANDS\n";
        for (const CommandText& other : all)
            page += fmt::format(".TP\n.BR {} (1)\n{}\n", literal(page_name(other)), literal(other.doc));
    }
    page += ".SH OPTIONS\n";
    for (const FlagText& positional : command.positionals) add_flag(page, positional);
    std::string group = "Options";
    for (const FlagText& flag : command.flags)
        if (flag.group == group) add_flag(page, flag);
    for (const FlagText& flag : command.flags) {
        if (flag.group == "Options") continue;
        if (flag.group != group) page += fmt::format(".SS {}\n", literal(flag.group));
        group = flag.group;
        add_flag(page, flag);
    }
    page += ".SH EXAMPLES\n.nf\n";
    for (const std::string& example : command.examples) page += literal(example) + "\n";
    page +=
        ".fi\n.SH EXIT STATUS\n0: done. 1: the request is wrong. 2: the machine failed. 3, of compare: they differ; of "
        "farm status: pictures are missing.\n";
    if (!command.name.empty()) page += ".SH SEE ALSO\n.BR darkroom (1)\n";
    return page;
}

Result<> write_all(std::span<const CommandText> pages, std::span<const CommandText> all, const std::string& folder) {
    std::error_code error;
    if (!std::filesystem::is_directory(folder, error))
        return darkroom::user_error(fmt::format("-o {}: no such folder", darkroom::printable(folder)));
    for (const CommandText& command : pages) {
        const std::string text = page_of(command, all);
        const std::filesystem::path path = std::filesystem::path(folder) / (page_name(command) + ".1");
        DARKROOM_TRY(darkroom::write_own_file(path, std::as_bytes(std::span(text)), darkroom::FileOwner::Anyone));
    }
    return {};
}

int run(const CLI::App& program, const std::string& name, const std::string& folder) {
    const std::vector<CommandText> all = describe_all(program);
    std::vector<CommandText> pages{describe(program)};
    pages.insert(pages.end(), all.begin(), all.end());
    if (!name.empty() || folder.empty()) {
        const auto found = std::ranges::find(pages, name, &CommandText::name);
        if (found == pages.end()) return fail_user(fmt::format("man: no command '{}'", darkroom::printable(name)));
        if (folder.empty()) {
            fmt::print("{}", page_of(*found, all));
            return exit_ok;
        }
        pages = {*found};
    }
    const Result<> done = write_all(pages, all, folder);
    return done ? exit_ok : fail(done.error());
}

}  // namespace

Command add_man(CommandFlags program) {
    struct Options {
        std::string name, folder;
    };
    const CommandFlags command = program.add_command("man", "Prints the manual page of a command, or writes all");
    command.examples(
        "darkroom man\n"
        "darkroom man develop > darkroom-develop.1\n"
        "darkroom man --output .");
    const auto options = std::make_shared<Options>();
    command.add_option("NAME", options->name, "A command (\"lut export\"); without it the page of the program");
    command.add_option("-o,--output", options->folder, "The folder that all pages go to").type_name("DIR");
    return {command, [options, program] { return run(program.parser(), options->name, options->folder); }};
}

}  // namespace app
