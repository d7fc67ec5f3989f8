// SPDX-License-Identifier: MIT
#pragma once
// Tests of play and edit run the built program in a display of their own (Xvfb) with a small window manager, press its
// keys, and read what it says: a line on standard output for what a key did, an error on standard error.

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <functional>
#include <optional>
#include <thread>

#include "tests/cli/cli_support.hpp"
#include "tests/places.hpp"

namespace darkroom::test {

/// A program that runs beside the test, ended with this object.
class Process {
  public:
    Process(const std::vector<std::string>& command, const std::filesystem::path& out, const std::filesystem::path& err,
            const std::filesystem::path& folder, int inherited = -1, int input = -1) {
        id_ = fork();
        if (id_ != 0) return;
        const auto open_as = [](const std::filesystem::path& path, int as) {
            const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
            dup2(file, as);
            close(file);
        };
        open_as(out, STDOUT_FILENO);
        open_as(err, STDERR_FILENO);
        if (inherited >= 0) fcntl(inherited, F_SETFD, 0);
        if (input >= 0) dup2(input, STDIN_FILENO);
        std::vector<char*> arguments;
        for (const std::string& argument : command) arguments.push_back(const_cast<char*>(argument.c_str()));
        arguments.push_back(nullptr);
        if (chdir(folder.c_str()) == 0) execvp(arguments[0], arguments.data());
        _exit(127);
    }
    Process(const Process&) = delete;
    Process& operator=(const Process&) = delete;
    ~Process() {
        if (!is_running()) return;
        kill(id_, SIGTERM);
        for (int i = 0; i < 100 && is_running(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(20));
        if (!is_running()) return;
        kill(id_, SIGKILL);
        waitpid(id_, nullptr, 0);
    }
    [[nodiscard]] bool is_running() {
        if (code_) return false;
        int status = 0;
        if (waitpid(id_, &status, WNOHANG) != id_) return true;
        code_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128;
        return false;
    }
    /// Waits for its end; nothing: it did not come.
    [[nodiscard]] std::optional<int> wait(std::chrono::seconds most) {
        const auto end = std::chrono::steady_clock::now() + most;
        while (is_running() && std::chrono::steady_clock::now() < end)
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
        return code_;
    }
    [[nodiscard]] pid_t id() const { return id_; }

  private:
    pid_t id_ = -1;
    std::optional<int> code_;
};

/// The greatest difference of two pictures.
inline double difference(const Picture& a, const Picture& b) {
    const Result<Comparison> result = compare(a, b);
    EXPECT_TRUE(result) << result.error().text;
    return result ? result->max_error : 1;
}

class ViewerFixture : public CliFixture {
  protected:
    /// Of copies, with what they name: windows leave files beside what they edit.
    std::string scenes_folder, looks_folder;

    void SetUp() override {
        CliFixture::SetUp();
        scenes_folder = path("scenes/");
        looks_folder = path("looks/");
        // What windows keep for their user is the test's own.
        setenv("XDG_CONFIG_HOME", path("config").c_str(), 1);
        for (const char* const folder : {"scenes", "looks", "hud", "controllers"})
            std::filesystem::copy(std::filesystem::path(source_folder) / folder, path(folder),
                                  std::filesystem::copy_options::recursive);
        if (!has("Xvfb") || !has("openbox") || !has("xdotool"))
            GTEST_SKIP() << "packages xvfb, openbox and xdotool are needed to open windows";
        std::array<int, 2> ends{};
        ASSERT_EQ(pipe2(ends.data(), O_CLOEXEC), 0);
        // Without -noreset it begins anew, and loses who is just connecting, when the last of the others leaves.
        display_ = std::make_unique<Process>(
            std::vector<std::string>{"Xvfb", "-displayfd", std::to_string(ends[1]), "-screen", "0", "1920x1080x24",
                                     "-nolisten", "tcp", "-noreset", "-fbdir", path("")},
            path("xvfb.log"), path("xvfb.err"), path(""), ends[1]);
        close(ends[1]);
        std::string number;
        char digit = 0;
        while (read(ends[0], &digit, 1) == 1 && digit != '\n') number += digit;
        close(ends[0]);
        ASSERT_FALSE(number.empty()) << "no display: " << content(path("xvfb.err"));
        setenv("DISPLAY", (":" + number).c_str(), 1);
        manager_ = std::make_unique<Process>(std::vector<std::string>{"openbox", "--sm-disable"}, path("openbox.log"),
                                             path("openbox.err"), path(""));
        ASSERT_TRUE(wait_until([] { return shell("xdotool get_desktop") == 0; }, 30)) << "no window manager";
        const std::string set = "xprop -root -f RESOURCE_MANAGER 8s -set RESOURCE_MANAGER";
        if (dots_per_inch() != 96 && shell(fmt::format("{} 'Xft.dpi: {}'", set, dots_per_inch())) != 0)
            GTEST_SKIP() << "package x11-utils is needed to scale a display";
    }
    /// Of the display: at 192 all is twice as large, if the program xprop is there.
    [[nodiscard]] virtual int dots_per_inch() const { return 96; }
    void TearDown() override {
        viewer_.reset();
        close(commands_);
        manager_.reset();
        display_.reset();
        unsetenv("DISPLAY");
        unsetenv("XDG_CONFIG_HOME");
        CliFixture::TearDown();
    }

    /// Starts the program, by another where one is named before it, and waits for its window.
    void start(const std::vector<std::string>& arguments, std::vector<std::string> command = {}) {
        command.emplace_back(program);
        command.insert(command.end(), arguments.begin(), arguments.end());
        command.emplace_back("--commands");
        std::array<int, 2> ends{};
        ASSERT_EQ(socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()), 0);
        close(std::exchange(commands_, ends[0]));
        viewer_ = std::make_unique<Process>(command, path("out.txt"), path("err.txt"), path(""), -1, ends[1]);
        close(ends[1]);
        const bool is_open = wait_until(
            [&] {
                window_ = answer("xdotool search --onlyvisible --name Darkroom");
                return !window_.empty() || !viewer_->is_running();
            },
            120);
        ASSERT_TRUE(is_open && !window_.empty()) << said() << complained();
        ASSERT_EQ(shell("xdotool windowactivate --sync " + window_), 0);
        // Keys that are pressed before the first frame would be of no one.
        ASSERT_TRUE(wait_for("ready")) << said() << complained();
    }
    /// Presses a key by its X name: "F5", "ctrl+s".
    void press(const std::string& key) const { ASSERT_EQ(shell("xdotool key " + key), 0) << key; }
    /// Presses a key and waits for what it says.
    void press(const std::string& key, const std::string& line) {
        const std::size_t before = count(line);
        press(key);
        EXPECT_TRUE(wait_until([&] { return count(line) > before; }, 60)) << key << ": " << said() << complained();
    }
    [[nodiscard]] bool wait_for(const std::string& line) {
        return wait_until([&] { return count(line) > 0; }, 120);
    }
    /// Tells the console, on standard input.
    void command(const std::string& text) const {
        const std::string line = text + '\n';
        ASSERT_EQ(send(commands_, line.data(), line.size(), MSG_NOSIGNAL), static_cast<ssize_t>(line.size()));
    }
    /// Where a widget of edit lies in the window: left, top, right, bottom.
    [[nodiscard]] std::array<int, 4> place(const std::string& name) const {
        std::array<int, 4> out{};
        std::istringstream numbers(ask("places " + name, "place " + name + " "));
        for (int& number : out) numbers >> number;
        return out;
    }
    /// Presses the mouse's first button there, moves it to another place, and lets it go: a click where both are one.
    /// Each step waits for the frame that has seen it.
    void drag(std::array<int, 2> from, std::array<int, 2> to) const {
        const auto act = [&](const std::string& what, const char* button, std::array<int, 2> at) {
            ASSERT_EQ(shell("xdotool " + what), 0);
            (void)ask("places mouse/", fmt::format("place mouse/{} {} {} ", button, at[0], at[1]));
        };
        const auto move = [&](const char* button, std::array<int, 2> at) {
            act(fmt::format("mousemove --window {} {} {}", window_, at[0], at[1]), button, at);
        };
        move("up", from);
        act("mousedown 1", "down", from);
        if (to != from) move("down", {(from[0] + to[0]) / 2, (from[1] + to[1]) / 2});
        if (to != from) move("down", to);
        act("mouseup 1", "up", to);
    }
    void click(const std::string& name) const {
        const auto [left, top, right, bottom] = place(name);
        drag({(left + right) / 2, (top + bottom) / 2}, {(left + right) / 2, (top + bottom) / 2});
    }
    /// Stores the picture, and reads it.
    [[nodiscard]] Picture shot() {
        press("F12", "stored darkroom-");
        const std::string text = said();
        const std::size_t at = text.rfind("stored ") + 7;
        return picture(text.substr(at, text.find('\n', at) - at));
    }
    /// What the display shows within these sides, as somebody in front of it sees it. It may be between two frames.
    [[nodiscard]] Picture seen(const std::array<int, 4>& sides) const {
        const std::string file = content(path("Xvfb_screen0"));
        const auto number = [&](std::size_t at) {
            std::uint32_t out = 0;
            for (std::size_t i = 0; i < 4; ++i) out = out << 8U | static_cast<std::uint8_t>(file[4 * at + i]);
            return out;
        };
        // The header of XWD: where pixels begin, bytes a row. The window's place is that of its first pixel.
        const std::size_t begin = number(0) + std::size_t{12} * number(19), row = number(12);
        std::istringstream place(
            answer("xdotool getwindowgeometry --shell " + window_ + " | sed -n 's/^[XY]=//p' | xargs"));
        int left = 0, top = 0;
        place >> left >> top;
        Picture out(static_cast<std::uint32_t>(sides[2] - sides[0]), static_cast<std::uint32_t>(sides[3] - sides[1]));
        float* to = out.pixels.data();
        for (int y = top + sides[1]; y < top + sides[3]; ++y)
            for (int x = left + sides[0]; x < left + sides[2]; ++x) {
                const std::size_t at = begin + static_cast<std::size_t>(y) * row + 4 * static_cast<std::size_t>(x);
                for (const std::size_t channel : {2U, 1U, 0U})
                    *to++ = static_cast<float>(static_cast<std::uint8_t>(file[at + channel])) / 255;
                *to++ = 1;
            }
        return out;
    }
    /// Ends the program as its window's frame does; the validation layer has said nothing.
    void leave() {
        press("alt+F4");
        const std::optional<int> code = viewer_->wait(std::chrono::seconds(60));
        EXPECT_EQ(code, 0) << said() << complained();
        EXPECT_EQ(complained(), "");
    }

    [[nodiscard]] std::string said() const { return content(path("out.txt")); }
    [[nodiscard]] std::string complained() const { return content(path("err.txt")); }
    [[nodiscard]] std::size_t count(const std::string& line) const {
        const std::string text = said();
        std::size_t found = 0;
        for (std::size_t at = text.find(line); at != std::string::npos; at = text.find(line, at + 1)) ++found;
        return found;
    }
    [[nodiscard]] static bool wait_until(const std::function<bool()>& is_true, int seconds) {
        const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(seconds);
        while (std::chrono::steady_clock::now() < end) {
            if (is_true()) return true;
            std::this_thread::sleep_for(std::chrono::milliseconds(30));
        }
        return is_true();
    }
    [[nodiscard]] static int shell(const std::string& command) {
        return std::system((command + " >/dev/null 2>&1").c_str());
    }
    [[nodiscard]] std::string answer(const std::string& command) const {
        const std::string file = path("answer.txt");
        (void)std::system((command + " >" + quoted(file) + " 2>/dev/null").c_str());
        std::string text = content(file);
        return text.substr(0, text.find('\n'));
    }
    [[nodiscard]] const std::string& window() const { return window_; }
    [[nodiscard]] Process& viewer() { return *viewer_; }

    /// Asks the console until an answer begins so, and returns the rest of its line.
    [[nodiscard]] std::string ask(const std::string& question, const std::string& begin) const {
        const std::size_t before = said().size();
        std::string answer;
        const bool is_told = wait_until(
            [&] {
                command(question);
                const std::string text = said();
                const std::size_t at = text.find(begin, before);
                if (at != std::string::npos)
                    answer = text.substr(at + begin.size(), text.find('\n', at) - at - begin.size());
                return at != std::string::npos;
            },
            60);
        EXPECT_TRUE(is_told) << begin << " is not in " << said() << complained();
        return answer;
    }

  private:
    [[nodiscard]] static bool has(const std::string& name) { return shell("command -v " + name) == 0; }

    std::unique_ptr<Process> display_, manager_, viewer_;
    std::string window_;
    int commands_ = -1;  ///< the viewer's standard input
};

}  // namespace darkroom::test
