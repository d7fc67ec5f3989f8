// SPDX-License-Identifier: MIT
// What a console's commands do. Every run has a budget: files may hold anything, and may run each other.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <utility>

#include "core/files.hpp"
#include "core/lies_in.hpp"
#include "core/text/param_text.hpp"
#include "script/console_state.hpp"

namespace darkroom::script {

namespace {

bool is_blank(char letter) { return static_cast<unsigned char>(letter) <= ' ' || letter == '\x7f'; }

}  // namespace

std::optional<std::string_view> CommandReader::word() {
    while (!rest_.empty() && rest_[0] != '\n' && is_blank(rest_[0])) rest_.remove_prefix(1);
    if (rest_.starts_with("//")) rest_.remove_prefix(std::min(rest_.find('\n'), rest_.size()));
    if (rest_.empty()) return std::nullopt;
    if (rest_[0] == '\n' || rest_[0] == ';') {
        if (rest_[0] == '\n') ++line_;
        rest_.remove_prefix(1);
        return std::nullopt;
    }
    const bool is_quoted = rest_[0] == '"';
    if (is_quoted) rest_.remove_prefix(1);
    const auto is_end = [&](char letter) {
        return letter == '\n' || (is_quoted ? letter == '"' : letter == ';' || is_blank(letter));
    };
    const auto length = static_cast<std::size_t>(std::ranges::find_if(rest_, is_end) - rest_.begin());
    const std::string_view found = rest_.substr(0, length);
    rest_.remove_prefix(length);
    if (is_quoted && rest_.starts_with('"')) rest_.remove_prefix(1);
    return found;
}

std::optional<Command> CommandReader::next() {
    while (!rest_.empty()) {
        Command command{.line = line_};
        while (const auto found = word()) command.words.push_back(*found);
        if (!command.words.empty()) return command;
    }
    return std::nullopt;
}

namespace {

constexpr std::uint32_t max_lines = 2000, max_shown_refusals = 64, deepest = 8;
constexpr std::size_t longest_file = std::size_t{1} << 20, max_words = 64, max_kept = 1000;

using Words = std::span<const std::string_view>;

class Run {
  public:
    Run(Console::State& state, const RunOptions& options)
        : state_(state), options_(options), left_(options.execute.max_commands) {}

    void text(std::string_view commands_text, const std::string& place);
    std::uint32_t end();

    using Function = Result<> (Run::*)(Words);
    struct Known {
        std::string_view name, arguments;
        std::size_t least, most;  ///< words behind the name
        Function function;
        std::string_view doc;
    };
    static const std::array<Known, 12> commands;

  private:
    Result<> command(Words words);
    Result<> get(Words arguments);
    Result<> set(Words arguments);
    Result<> seta(Words arguments);
    Result<> toggle(Words arguments);
    Result<> cycle(Words arguments);
    Result<> inc(Words arguments);
    Result<> reset(Words arguments);
    Result<> reset_all(Words) { return reset_where(false); }
    Result<> reset_config(Words) { return reset_where(true); }
    Result<> list(Words arguments);
    Result<> exec(Words arguments);
    Result<> help(Words arguments);

    Result<> write(std::string_view name, const Variable& variable, std::string_view value);
    /// Sets the value behind the present one in a list, the first if it is not in it.
    Result<> write_next(std::string_view name, const Variable& variable, std::span<const std::string> values);
    Result<> reset_where(bool archived_alone);
    [[nodiscard]] std::string default_text(const Variable& variable) const {
        return variable_text(*variable.row, state_.defaults(variable));
    }
    /// Puts a line of a configuration file aside whose variable is not there. False: it is none.
    bool keep(std::string_view name, Words values, bool is_archived);
    [[nodiscard]] bool suggests() const { return options_.execute.suggests && refused_ < max_shown_refusals; }
    [[nodiscard]] Result<Variable> look_up(std::string_view name) const { return state_.variable(name, suggests()); }
    void print(Severity severity, std::string_view line);
    /// Commands that do the work of many count as many.
    bool spend(std::size_t count);

    Console::State& state_;
    const RunOptions& options_;
    std::uint32_t left_, lines_ = 0, refused_ = 0, depth_ = 0;
    bool is_over_ = false;
};

constexpr std::array<Run::Known, 12> Run::commands{{
    {"get", "NAME", 1, 1, &Run::get, "Prints a variable; its name alone does, too."},
    {"set", "NAME VALUE", 2, max_words, &Run::set, "Sets a variable; NAME VALUE does, too."},
    {"seta", "NAME VALUE", 2, max_words, &Run::seta, "Sets a variable, and archives it from now on."},
    {"toggle", "NAME [VALUE [OTHER]]", 1, 3, &Run::toggle, "Goes between 0 and 1, or two values."},
    {"cycle", "NAME [VALUE...]", 1, max_words, &Run::cycle, "Goes to the value behind the present one."},
    {"inc", "NAME [AMOUNT]", 1, 2, &Run::inc, "Adds an amount, or 1."},
    {"reset", "NAME", 1, 1, &Run::reset, "Goes back to the default."},
    {"resetall", "", 0, 0, &Run::reset_all, "The same for all variables."},
    {"resetcfg", "", 0, 0, &Run::reset_config, "The same for those that are archived."},
    {"cvarlist", "[PREFIX]", 0, 1, &Run::list, "Lists variables and their values."},
    {"exec", "FILE", 1, 1, &Run::exec, "Runs a file of the console's folder."},
    {"help", "[NAME]", 0, 1, &Run::help, "Explains a variable or a command, or lists the commands."},
}};

void Run::print(Severity severity, std::string_view line) {
    if (lines_++ >= max_lines) return;
    const LogSink& own = options_.execute.print;
    (own ? own : state_.desc.print)(severity, line);
}

bool Run::spend(std::size_t count) {
    is_over_ = is_over_ || count > left_;
    if (!is_over_) left_ -= static_cast<std::uint32_t>(count);
    return !is_over_;
}

void Run::text(std::string_view commands_text, const std::string& place) {
    CommandReader reader(commands_text);
    while (const auto read = reader.next()) {
        if (!spend(1)) return;
        const auto done = command(read->words);
        if (done || refused_++ >= max_shown_refusals) continue;
        print(Severity::Error,
              place.empty() ? done.error().text : fmt::format("{}:{}: {}", place, read->line, done.error().text));
    }
}

std::uint32_t Run::end() {
    lines_ = 0;  // what follows is always shown
    if (refused_ > max_shown_refusals)
        print(Severity::Error, fmt::format("and {} more commands that were refused", refused_ - max_shown_refusals));
    if (is_over_) {
        ++refused_;
        print(Severity::Error, fmt::format("more commands than are allowed in one go, {}: the others are left out",
                                           options_.execute.max_commands));
    }
    return refused_;
}

Result<> Run::command(Words words) {
    const std::string_view name = words[0];
    const Words arguments = words.subspan(1);
    const auto known = std::ranges::find(commands, name, &Known::name);
    if (known != commands.end()) {
        if (arguments.size() < known->least || arguments.size() > known->most)
            return user_error(
                fmt::format("{} with {} words: allowed is {} {}", name, arguments.size(), name, known->arguments));
        return (this->*known->function)(arguments);
    }
    if (find_variable(*state_.composer, name)) return arguments.empty() ? get(words) : set(words);
    if (keep(name, arguments, false)) return {};
    std::vector<std::string> names = {};
    if (suggests()) {
        for (const Known& one : commands) names.emplace_back(one.name);
        for (NamedVariable& one : all_variables(*state_.composer)) names.push_back(std::move(one.name));
    }
    return user_error(fmt::format("'{}': no such command or variable{}", printable(name), suggestion(name, names)));
}

bool Run::keep(std::string_view name, Words values, bool is_archived) {
    if (options_.kept == nullptr || values.empty() || options_.kept->size() >= max_kept) return false;
    std::string line = fmt::format("{}\"{}\"", is_archived ? "seta " : "", name);
    for (const std::string_view value : values) line += fmt::format(" \"{}\"", value);
    options_.kept->insert_or_assign(std::string(name), std::move(line));
    return true;
}

Result<> Run::write(std::string_view name, const Variable& variable, std::string_view value) {
    DARKROOM_TRY_VALUE(const auto written, state_.write(name, variable, value));
    if (!written.empty()) print(Severity::Warning, written);
    return {};
}

Result<> Run::get(Words arguments) {
    DARKROOM_TRY_VALUE(const auto variable, look_up(arguments[0]));
    print(Severity::Info, fmt::format("\"{}\" is \"{}\"", printable(arguments[0]), state_.text(variable)));
    return {};
}

Result<> Run::set(Words arguments) {
    const auto variable = look_up(arguments[0]);
    if (!variable) return keep(arguments[0], arguments.subspan(1), false) ? Result<>{} : failure(variable.error());
    // A vector may be given as words: `fog.color 1 0.5 0`.
    if (arguments.size() - 1 > variable->row->words)
        return user_error(fmt::format("{}: {} values are given, it takes {}", printable(arguments[0]),
                                      arguments.size() - 1, expected_kind(variable->row->kind)));
    return write(arguments[0], *variable, fmt::format("{}", fmt::join(arguments.subspan(1), ",")));
}

Result<> Run::seta(Words arguments) {
    const auto variable = find_variable(*state_.composer, arguments[0]);
    if (!variable && keep(arguments[0], arguments.subspan(1), true)) return {};
    auto done = set(arguments);
    if (done) state_.archived.insert(name_of(*state_.composer, *variable));
    return done;
}

Result<> Run::write_next(std::string_view name, const Variable& variable, std::span<const std::string> values) {
    const std::string now = state_.text(variable);
    std::size_t next = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        DARKROOM_TRY_VALUE(const auto value, read_value(*variable.row, name, values[i]));
        std::vector<std::uint32_t> words(variable.row->word);
        words.insert(words.end(), value.words.begin(), value.words.end());
        if (variable_text(*variable.row, words) != now) continue;
        next = i + 1;
        break;
    }
    return write(name, variable, values[next % values.size()]);
}

Result<> Run::toggle(Words arguments) {
    DARKROOM_TRY_VALUE(const auto variable, look_up(arguments[0]));
    if (arguments.size() > 1) {
        const std::string other = arguments.size() > 2 ? std::string(arguments[2]) : default_text(variable);
        return write_next(arguments[0], variable, std::array{std::string(arguments[1]), other});
    }
    const auto number = parse_number(state_.text(variable));
    if (!number)
        return user_error(
            fmt::format("{} is not a number: name the values that it toggles between", printable(arguments[0])));
    return write(arguments[0], variable, *number == 0 ? "1" : "0");
}

Result<> Run::cycle(Words arguments) {
    DARKROOM_TRY_VALUE(const auto variable, look_up(arguments[0]));
    const std::span<const std::string_view> choices = variable.row->choices;
    const Words given = arguments.size() > 1 ? arguments.subspan(1) : choices;
    if (given.empty())
        return user_error(fmt::format("{}: name the values that it cycles through", printable(arguments[0])));
    return write_next(arguments[0], variable, std::vector<std::string>(given.begin(), given.end()));
}

Result<> Run::inc(Words arguments) {
    DARKROOM_TRY_VALUE(const auto variable, look_up(arguments[0]));
    const auto number = parse_number(state_.text(variable));
    const auto amount = arguments.size() > 1 ? parse_number(arguments[1]) : std::optional(1.0);
    if (!amount)
        return user_error(
            fmt::format("inc {}: '{}' is not a number", printable(arguments[0]), printable(arguments[1])));
    if (!number) return user_error(fmt::format("inc {}: it is not a number", printable(arguments[0])));
    return write(arguments[0], variable, fmt::format("{}", *number + *amount));
}

Result<> Run::reset(Words arguments) {
    DARKROOM_TRY_VALUE(const auto variable, look_up(arguments[0]));
    DARKROOM_TRY(write(arguments[0], variable, default_text(variable)));
    state_.set_by_hand.erase(name_of(*state_.composer, variable));
    return {};
}

Result<> Run::reset_where(bool archived_alone) {
    if (!spend(variable_count(*state_.composer))) return {};
    const std::vector<NamedVariable> all = all_variables(*state_.composer);
    for (const auto& [name, variable] : all) {
        if (state_.is_read_only(variable) || (archived_alone && !state_.is_archived(variable))) continue;
        DARKROOM_TRY(write(name, variable, default_text(variable)));
        state_.set_by_hand.erase(name_of(*state_.composer, variable));
    }
    return {};
}

Result<> Run::list(Words arguments) {
    const std::string_view prefix = arguments.empty() ? std::string_view() : arguments[0];
    if (!spend(variable_count(*state_.composer))) return {};
    const std::vector<NamedVariable> all = all_variables(*state_.composer, prefix);
    for (const auto& [name, variable] : all)
        print(Severity::Info, fmt::format("{} {} \"{}\"", state_.is_archived(variable) ? '*' : ' ', printable(name),
                                          state_.text(variable)));
    print(Severity::Info, prefix.empty()
                              ? fmt::format("{} variables", all.size())
                              : fmt::format("{} variables beginning with \"{}\"", all.size(), printable(prefix)));
    return {};
}

Result<> Run::exec(Words arguments) {
    const std::string shown = printable(arguments[0]);
    if (!options_.execute.allows_files || state_.desc.folder.empty())
        return user_error(fmt::format("exec {}: files are not read from here", shown));
    const std::filesystem::path file(arguments[0]);
    const bool climbs = std::ranges::any_of(file, [](const auto& part) { return part == ".."; });
    if (file.empty() || file.is_absolute() || climbs || arguments[0].find('\0') != std::string_view::npos)
        return user_error(fmt::format("exec {}: allowed is a file of the console's folder, or of one in it", shown));
    if (depth_ >= deepest) return user_error(fmt::format("exec {}: files run files at most {} deep", shown, deepest));
    const std::filesystem::path path = state_.desc.folder / file;
    std::error_code ignored;
    if (std::filesystem::exists(path, ignored) && !lies_in(state_.desc.folder, path))
        return user_error(fmt::format("exec {}: leads out of the console's folder", shown));
    DARKROOM_TRY_VALUE(const auto content, read_file(path, {.max_size = longest_file}));
    ++depth_;
    text({reinterpret_cast<const char*>(content.data()), content.size()}, path.string());
    --depth_;
    return {};
}

Result<> Run::help(Words arguments) {
    const auto tell = [&](const Known& one) {
        const std::string usage = fmt::format("{}{}{}", one.name, one.arguments.empty() ? "" : " ", one.arguments);
        print(Severity::Info, fmt::format("{:<28}{}", usage, one.doc));
    };
    if (arguments.empty()) {
        for (const Known& one : commands) tell(one);
        print(Severity::Info, "help NAME explains a variable; cvarlist lists them.");
        return {};
    }
    const auto known = std::ranges::find(commands, arguments[0], &Known::name);
    if (known != commands.end()) {
        tell(*known);
        return {};
    }
    DARKROOM_TRY_VALUE(const auto variable, look_up(arguments[0]));
    const ParamInfo& row = *variable.row;
    print(Severity::Info, fmt::format("{}: {} It takes {}, by default {}, now {}.", printable(arguments[0]), row.doc,
                                      interval(row), default_text(variable), state_.text(variable)));
    return {};
}

}  // namespace

std::vector<std::string> command_names(std::string_view prefix) {
    std::vector<std::string> out;
    for (const Run::Known& one : Run::commands)
        if (one.name.starts_with(prefix)) out.emplace_back(one.name);
    return out;
}

std::uint32_t run_commands(Console::State& state, std::string_view text, const RunOptions& options) {
    Run run(state, options);
    run.text(text, options.place);
    return run.end();
}

}  // namespace darkroom::script
