// SPDX-License-Identifier: MIT
// From a description to passes.

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "custom/description.hpp"
#include "custom/light.hpp"
#include "plan/frame_inputs.hpp"
#include "shared/scene_images.hpp"

namespace darkroom::custom {

namespace {

class Build {
  public:
    Build(PassBuilder& builder, const Description& from) : builder_(builder), from_(from) {
        for (const FileImage& image : from.images) declare(image);
        for (const FileBuffer& buffer : from.buffers) declare(buffer);
    }

    void run() {
        for (const FileFunction& pass : from_.passes) pass.is_compute ? add_compute(pass) : add(pass);
        if (!from_.result.empty()) builder_.result(images_[from_.result]);
        if (!from_.end) return;
        if (from_.end->reads_light) builder_.end_constants(light_vectors, write_light);
        for (const std::string_view input : from_.end->inputs) {
            const plan::FrameInput* const of_frame = frame_row(input);
            const PassVector neutral = of_frame == nullptr ? PassVector{} : of_frame->neutral;
            builder_.side(std::string(input), image(input), neutral);
        }
        for (const FileBufferUse& use : from_.end->buffers)
            builder_.value_side(std::string(use.name), buffers_[use.name]);
    }

  private:
    void declare(const FileImage& image) {
        const PassImageDesc desc{.name = std::string(image.name),
                                 .format = image.format,
                                 .numerator = image.ratio.numerator,
                                 .denominator = image.ratio.denominator};
        switch (image.kind) {
            case FileImage::Kind::Image:
                images_[image.name] = builder_.create(desc);
                return;
            case FileImage::Kind::Table:
                images_[image.name] = builder_.table(image.table);
                return;
            case FileImage::Kind::History:
                const PassBuilder::History history = builder_.history(desc);
                images_[image.name] = history.current;
                previous_[image.name] = history.previous;
                return;
        }
    }
    void declare(const FileBuffer& buffer) {
        buffers_[buffer.name] = buffer.is_value
                                    ? builder_.value(fmt::format("{}.{}", from_.info.name, buffer.name), buffer.count)
                                    : builder_.create_buffer(buffer.name, buffer.element_bytes * buffer.count);
    }

    /// What passes of both kinds have.
    template <class Desc>
    Desc begin(const FileFunction& pass) {
        Desc desc{.name = std::string(pass.name), .shader = pass.shader};
        for (const std::string_view input : pass.inputs)
            desc.inputs.push_back({.name = std::string(input), .image = image(input)});
        if (pass.reads_light) {
            desc.custom_vectors = light_vectors;
            desc.constants = write_light;
        }
        return desc;
    }

    void take(const FileFunction& pass, const std::vector<PassImage>& made) {
        for (std::size_t i = 0; i < made.size(); ++i) images_[pass.outputs[i]] = made[i];
    }

    void add(const FileFunction& pass) {
        auto desc = begin<KernelPassDesc>(pass);
        desc.output = images_[pass.outputs[0]];
        for (std::size_t i = 1; i < pass.outputs.size(); ++i) desc.more_outputs.push_back(images_[pass.outputs[i]]);
        for (const FileBufferUse& use : pass.buffers)
            desc.values.push_back({std::string(use.name), buffers_[use.name]});
        take(pass, builder_.add_all(desc));
    }

    void add_compute(const FileFunction& pass) {
        auto desc = begin<ComputePassDesc>(pass);
        for (const std::string_view output : pass.outputs)
            desc.outputs.push_back({.name = std::string(output), .image = images_[output]});
        for (const FileBufferUse& use : pass.buffers) {
            const auto buffer = std::ranges::find(from_.buffers, use.name, &FileBuffer::name);
            desc.buffers.push_back({std::string(use.name), buffers_[use.name], use.access, std::string(buffer->type)});
        }
        desc.workgroup = pass.workgroup;
        desc.groups = pass.groups;
        desc.shared_bytes = pass.shared_bytes;
        take(pass, builder_.add_compute(desc));
    }

    static const plan::FrameInput* frame_row(std::string_view name) {
        const auto found = std::ranges::find(plan::frame_inputs, name, &plan::FrameInput::shader_name);
        return found == plan::frame_inputs.end() ? nullptr : &*found;
    }

    PassImage image(std::string_view name) {
        if (name == "picture") return builder_.picture();
        if (name == "source") return builder_.source();
        if (const plan::FrameInput* const of_frame = frame_row(name)) return plain_image(builder_, of_frame->image);
        if (const auto found = images_.find(name); found != images_.end()) return found->second;
        return previous_.at(name.substr(0, name.rfind('_')));
    }

    PassBuilder& builder_;
    const Description& from_;
    std::map<std::string_view, PassImage> images_;    ///< as they are behind the passes so far
    std::map<std::string_view, PassImage> previous_;  ///< of histories, by their names
    std::map<std::string_view, PassBuffer> buffers_;
};

}  // namespace

void build(PassBuilder& builder, const Description& description) { Build(builder, description).run(); }

}  // namespace darkroom::custom
