// SPDX-License-Identifier: MIT
// Runs at build time: compiles every kernel in both stages, so that a mistake in a shader breaks the build with file
// and line. What it made lies in the folder that its argument names, for the tests of the compilers of GPUs.

#include <cstdio>

#include "every_kernel.hpp"
#include "gpu/shader/shader.hpp"

int main(int argc, char** argv) {
    using namespace darkroom;
    std::vector<gpu::ShaderSource> sources;
    for (const gpu::Stage stage : {gpu::Stage::Compute, gpu::Stage::Raster}) {
        const auto kernels =
            every_kernel({.stage_of = [=](const gpu::KernelSpec&) { return Result<gpu::Stage>(stage); }});
        if (!kernels) {
            std::fprintf(stderr, "error: %s\n", kernels.error().text.c_str());
            return 1;
        }
        for (const NamedKernel& kernel : *kernels) {
            const gpu::Stage own = kernel.spec.compute ? gpu::Stage::Compute : stage;
            const bool is_compute = own == gpu::Stage::Compute;
            sources.push_back({.name = kernel.name + (is_compute ? " (compute)" : " (raster)"),
                               .text = gpu::kernel_source(kernel.spec, own),
                               .stage = is_compute ? gpu::ShaderStage::Compute : gpu::ShaderStage::Fragment});
        }
    }
    gpu::ShaderCompiler compiler{argc > 1 ? std::filesystem::path(argv[1]) : std::filesystem::path()};
    int failures = 0;
    for (const auto& spirv : compiler.compile_all(sources)) {
        if (spirv) continue;
        std::fprintf(stderr, "%s\n", spirv.error().text.c_str());
        ++failures;
    }
    return failures == 0 ? 0 : 1;
}
