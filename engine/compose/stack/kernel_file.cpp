// SPDX-License-Identifier: MIT
// Which kernels a stack may ask for, and baking them.
#include <fmt/format.h>

#include <algorithm>
#include <darkroom/kernel_file.hpp>
#include <set>
#include <utility>

#include "compose/composer_state.hpp"
#include "core/caught.hpp"
#include "gpu/device/device_facts.hpp"
#include "gpu/kernel/kernel_pipeline.hpp"

namespace darkroom {

namespace {

/// The stack with one thing changed at a time.
std::vector<std::vector<plan::Entry>> switched(std::span<const plan::Entry> stack) {
    std::vector<std::vector<plan::Entry>> out;
    const auto with = [&](std::size_t entry, const auto& change) {
        change(out.emplace_back(stack.begin(), stack.end())[entry]);
    };
    for (std::size_t i = 0; i < stack.size(); ++i) {
        with(i, [](plan::Entry& entry) { entry.desc.enabled = !entry.desc.enabled; });
        for (const ParamInfo& row : stack[i].info->parameters.rows) {
            const std::uint32_t now = stack[i].base[row.word];
            const auto choices = static_cast<std::uint32_t>(row.kind == Kind::Toggle ? 2 : row.choices.size());
            for (std::uint32_t value = 0; value < choices; ++value)
                if (value != now) with(i, [&](plan::Entry& entry) { entry.base[row.word] = value; });
        }
    }
    return out;
}

/// Collects the kernels of stacks, each once.
class Wanted {
  public:
    void add(const gpu::KernelSpec& spec, gpu::Stage stage) {
        gpu::KernelText text(spec, stage);
        if (!known_.insert({text.digest, stage}).second) return;
        kernels_.push_back({spec.name, stage, std::move(text)});
    }
    [[nodiscard]] Result<> compile(gpu::ShaderCompiler& compiler, gpu::ShadersToBake& out) const {
        std::vector<gpu::ShaderSource> sources;
        for (const Kernel& kernel : kernels_)
            sources.push_back(gpu::kernel_shader(kernel.name, kernel.stage, kernel.text));
        if (std::ranges::find(kernels_, gpu::Stage::Raster, &Kernel::stage) != kernels_.end())
            sources.push_back(gpu::vertex_shader());
        const auto compiled = compiler.compile_all(sources);
        for (std::size_t i = 0; i < sources.size(); ++i) {
            if (!compiled[i]) return failure(compiled[i].error());
            out.words.insert_or_assign({sources[i].identity(), sources[i].stage}, *compiled[i]);
        }
        return {};
    }

  private:
    struct Kernel {
        std::string name;
        gpu::Stage stage = gpu::Stage::Compute;
        gpu::KernelText text;
    };
    std::set<std::pair<Digest, gpu::Stage>> known_;
    std::vector<Kernel> kernels_;
};

/// A planned stack, and what frames with other values of it ask for.
class PlannedStack {
  public:
    static Result<PlannedStack> make(gpu::Context& context, std::span<const plan::Entry> stack,
                                     const CompileDesc& desc) {
        DARKROOM_TRY_VALUE(auto program,
                           plan::plan_program(stack, desc, compose::planner_traits(context, desc.kernels)));
        DARKROOM_TRY_VALUE(auto compiled,
                           program.graph.compile(plan::largest_extents(desc), graph::measure_on(context)));
        return PlannedStack(std::move(program), std::move(compiled), desc);
    }
    Result<> add_complete(Wanted& wanted) const {
        for (std::uint32_t i = 0; i < program_.passes.size(); ++i) {
            if (compiled_.kept_pass_of({i}) == ~0u) continue;
            DARKROOM_TRY_VALUE(auto spec, plan::complete_spec(program_.passes[i]));
            wanted.add(spec, program_.passes[i].stage);
        }
        return {};
    }
    /// A compile asks for those of all passes, a frame for those that run.
    Result<> add_lean(std::span<const plan::Entry> values, bool is_at_compile, Wanted& wanted) {
        std::vector<const plan::Entry*> entries;
        for (const plan::Entry& entry : values) entries.push_back(&entry);
        const plan::FrameValues frame = plan::example_values(program_, desc_, entries);
        graph::Schedule schedule(compiled_);
        schedule.derive(frame.gates(), std::vector<graph::ImportState>(program_.imports.size()), 0);
        for (std::uint32_t i = 0; i < program_.passes.size(); ++i) {
            const std::uint32_t kept = compiled_.kept_pass_of({i});
            if (kept == ~0u || !(is_at_compile || schedule.runs(kept))) continue;
            const plan::ProgramPass& pass = program_.passes[i];
            const plan::Shape shape =
                plan::expected_shape(program_, compiled_, schedule, frame, entries, pass, plan::largest_extents(desc_));
            if (std::ranges::find(seen_[i], shape) != seen_[i].end()) continue;
            seen_[i].push_back(shape);
            DARKROOM_TRY_VALUE(auto spec, plan::lean_spec(pass, shape));
            wanted.add(spec, pass.stage);
        }
        return {};
    }

  private:
    PlannedStack(plan::Program program, graph::Compiled compiled, const CompileDesc& desc)
        : program_(std::move(program)), compiled_(std::move(compiled)), desc_(desc), seen_(program_.passes.size()) {}

    plan::Program program_;
    graph::Compiled compiled_;
    CompileDesc desc_;
    std::vector<std::vector<plan::Shape>> seen_;  ///< per pass
};

bool is_planned_alike(std::span<const plan::Entry> a, std::span<const plan::Entry> b) {
    return std::ranges::equal(a, b, [](const plan::Entry& one, const plan::Entry& other) {
        return one.values_at_compile() == other.values_at_compile();
    });
}

Result<> add_kernels(gpu::Context& context, std::span<const plan::Entry> stack, const CompileDesc& desc,
                     Wanted& wanted) {
    DARKROOM_TRY_VALUE(auto base, PlannedStack::make(context, stack, desc));
    DARKROOM_TRY(base.add_complete(wanted));
    DARKROOM_TRY(base.add_lean(stack, true, wanted));
    for (const std::vector<plan::Entry>& values : switched(stack)) {
        if (is_planned_alike(values, stack)) {
            DARKROOM_TRY(base.add_lean(values, false, wanted));
            continue;
        }
        DARKROOM_TRY_VALUE(auto other, PlannedStack::make(context, values, desc));
        DARKROOM_TRY(other.add_complete(wanted));
        DARKROOM_TRY(other.add_lean(values, true, wanted));
    }
    return {};
}

Result<> bake(const Wanted& wanted, gpu::ShadersToBake& out) {
    const std::filesystem::path caches = gpu::cache_folder_of({}, true);
    gpu::ShaderCompiler compiler(caches.empty() ? caches : caches / "shaders");
    if (!compiler.has_compiler)
        return user_error("baking kernels: this library has no compiler of GLSL (DARKROOM_COMPILER=OFF)");
    return wanted.compile(compiler, out);
}

}  // namespace

KernelFile::KernelFile() : shaders_(std::make_unique<gpu::ShadersToBake>()) {}
KernelFile::KernelFile(KernelFile&&) noexcept = default;
KernelFile& KernelFile::operator=(KernelFile&&) noexcept = default;
KernelFile::~KernelFile() = default;

Result<> KernelFile::add(const Composer& composer, const CompileDesc& desc) try {
    const Composer::State& state = *composer.state_;
    if (!state.context->is_assumed)
        return user_error("baking kernels: the composer is on a device; allowed is one on Device::assumed()");
    const DeviceProfile profile = *state.context->profile;
    if (!shaders_->words.empty() && shaders_->profile != profile)
        return user_error(fmt::format("baking kernels: the composer's device is of profile {}, and the file of {}",
                                      gpu::profile_name(profile), gpu::profile_name(shaders_->profile)));
    DARKROOM_TRY_VALUE(auto snapshot, state.snapshot(desc));
    Wanted wanted;
    DARKROOM_TRY(add_kernels(*state.context, snapshot.values, desc, wanted));
    shaders_->profile = profile;
    return bake(wanted, *shaders_);
} catch (...) {
    return caught("baking kernels");
}

std::size_t KernelFile::size() const { return shaders_->words.size(); }
std::vector<std::byte> KernelFile::bytes() const { return shaders_->bytes(); }

}  // namespace darkroom
