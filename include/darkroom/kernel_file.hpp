// SPDX-License-Identifier: MIT
#pragma once
// Kernels made ahead of time, as a file (.dkb) for DeviceDesc::kernels or AdoptDesc::kernels. A program that is given
// all its stacks ask for compiles no GLSL, and may link a library that was built without the compiler
// (DARKROOM_COMPILER=OFF). What is not in the file is then an error of the compile that needs it, but for lean kernels:
// the complete one, which is slower and gives the same picture, takes the place of one that is missing.
//
// A file is made for one kind of device. It is code: who hands it to a device trusts whoever made it.

#include <cstddef>
#include <darkroom/composer.hpp>
#include <darkroom/result.hpp>
#include <memory>
#include <vector>

namespace darkroom {

namespace gpu {
struct ShadersToBake;
}

class KernelFile {
  public:
    KernelFile();
    KernelFile(KernelFile&&) noexcept;
    KernelFile& operator=(KernelFile&&) noexcept;
    ~KernelFile();

    /// What this stack asks for in frames of `desc`, which should say of the images what the program will: the complete
    /// kernels, which serve whatever is switched; lean ones for the present values, and for those with one entry
    /// switched, or one toggle or choice changed; and the same again for toggles and choices that are read at compile.
    /// The Composer is on Device::assumed(), and all that are added to one file on the same kind. Errors: what
    /// compile() refuses; a library without the compiler.
    [[nodiscard]] Result<> add(const Composer& composer, const CompileDesc& desc);
    /// How many shaders there are.
    [[nodiscard]] std::size_t size() const;
    [[nodiscard]] std::vector<std::byte> bytes() const;

  private:
    std::unique_ptr<gpu::ShadersToBake> shaders_;
};

}  // namespace darkroom
