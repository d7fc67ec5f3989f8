// SPDX-License-Identifier: MIT
// The code of users' effects: the compiler of GLSL makes kernels of it, or an
// error of one line that names the effect's file. The compiler is in a child
// process, since it is a library that may end its process or never end.

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <darkroom/composer.hpp>
#include <darkroom/custom_effect.hpp>
#include <darkroom/kernel_file.hpp>

#include "fuzz/target.hpp"

namespace darkroom::fuzz::glsl_fuzz {
namespace {

constexpr unsigned max_seconds = 8;

std::string wrong_kernels(const CustomEffect& effect) {
    Composer composer(Device::assumed());
    composer.add(effect.info(), nullptr, {.second = effect.info().has_second() ? scene_color : Handle{}});
    const CompileDesc desc{.max_extent = {64, 48},
                           .depth = {VK_FORMAT_D32_SFLOAT},
                           .normals = {VK_FORMAT_R16G16B16A16_SFLOAT},
                           .velocity = {VK_FORMAT_R16G16_SFLOAT}};
    KernelFile file;
    const Result<> added = file.add(composer, desc);
    if (added) return file.size() > 0 ? std::string() : "there is no kernel";
    if (std::string wrong = wrong_error(added.error()); !wrong.empty()) return wrong;
    return added.error().text.find("a.glsl") != std::string::npos ? std::string()
                                                                  : "an error names no file: " + added.error().text;
}

/// What a child that runs this says is wrong, or how it ended.
std::string in_child(std::string (*run)(const CustomEffect&), const CustomEffect& effect) {
    std::array<int, 2> pipe{};
    if (::pipe(pipe.data()) != 0) std::abort();
    const pid_t child = fork();
    if (child == 0) {
        alarm(max_seconds);
        const std::string wrong = run(effect);
        const ssize_t written = write(pipe[1], wrong.data(), wrong.size());
        _exit(written == static_cast<ssize_t>(wrong.size()) ? 0 : 1);
    }
    close(pipe[1]);
    std::string wrong;
    std::array<char, 4096> part{};
    for (ssize_t count = 0; (count = read(pipe[0], part.data(), part.size())) > 0;)
        wrong.append(part.data(), static_cast<std::size_t>(count));
    close(pipe[0]);
    int status = 0;
    if (child < 0 || waitpid(child, &status, 0) != child) std::abort();
    if (WIFSIGNALED(status)) return fmt::format("the compiler's process ended with signal {}", WTERMSIG(status));
    return WEXITSTATUS(status) == 0 ? wrong : fmt::format("the compiler's process ended with {}", WEXITSTATUS(status));
}

std::string run(std::string_view input) {
    const Result<CustomEffect> effect = CustomEffect::parse(input, "a.glsl");
    // Other errors are the target `custom`'s.
    return effect ? in_child(wrong_kernels, *effect) : std::string();
}

std::vector<std::string> seeds() { return files("examples/*.glsl"); }

const Registration glsl({.name = "glsl", .run = run, .seeds = seeds, .longest = 2048});

}  // namespace
}  // namespace darkroom::fuzz::glsl_fuzz
