// SPDX-License-Identifier: MIT
#include "gpu/test_smallest/shader.hpp"

#include <set>

namespace darkroom::gpu::test {

namespace {

// Numbers of the SPIR-V specification, for what is read here.
namespace op {
enum : std::uint32_t {
    ExecutionMode = 16,
    Capability = 17,
    TypeBool = 20,
    TypeInt = 21,
    TypeFloat = 22,
    TypeVector = 23,
    TypeMatrix = 24,
    TypeImage = 25,
    TypeArray = 28,
    TypeStruct = 30,
    TypePointer = 32,
    Constant = 43,
    ConstantComposite = 44,
    SpecConstant = 50,
    SpecConstantComposite = 51,
    Variable = 59,
    Decorate = 71,
    MemberDecorate = 72,
    ExecutionModeId = 331,
};
}  // namespace op
constexpr std::uint32_t decoration_spec_id = 1, decoration_built_in = 11, decoration_non_writable = 24;
constexpr std::uint32_t built_in_workgroup_size = 25;
constexpr std::uint32_t mode_local_size = 17, mode_local_size_id = 38;
constexpr std::uint32_t class_uniform_constant = 0, class_workgroup = 4, class_storage_buffer = 12;
constexpr std::uint32_t image_is_storage = 2;
constexpr std::size_t header_words = 5;

using Operands = std::span<const std::uint32_t>;

struct Type {
    std::uint32_t opcode = 0;
    std::vector<std::uint32_t> operands;
};

class Reader {
  public:
    explicit Reader(const std::map<std::uint32_t, std::uint32_t>& specialization) : specialization_(specialization) {}

    ShaderFacts read(Operands words) {
        for (std::size_t at = header_words; at < words.size();) {
            const std::size_t count = words[at] >> 16U;
            if (count == 0 || count > words.size() - at) break;
            instruction(words[at] & 0xffffU, words.subspan(at + 1, count - 1));
            at += count;
        }
        for (std::size_t axis = 0; axis < workgroup_ids_.size() && axis < 3; ++axis)
            facts_.workgroup[axis] = constants_[workgroup_ids_[axis]];
        for (const Variable& variable : variables_) count(variable);
        return facts_;
    }

  private:
    struct Variable {
        std::uint32_t id, pointer, storage;
    };

    void instruction(std::uint32_t opcode, Operands words) {
        switch (opcode) {
            case op::Capability:
                facts_.capabilities.push_back(words[0]);
                break;
            case op::ExecutionMode:
                if (words[1] == mode_local_size) facts_.workgroup = {words[2], words[3], words[4]};
                break;
            case op::ExecutionModeId:
                if (words[1] == mode_local_size_id) workgroup_ids_.assign(words.begin() + 2, words.end());
                break;
            case op::Decorate:
                if (words[1] == decoration_spec_id) spec_ids_[words[0]] = words[2];
                if (words[1] == decoration_non_writable) non_writable_.insert(words[0]);
                if (words[1] == decoration_built_in && words[2] == built_in_workgroup_size) workgroup_ = words[0];
                break;
            case op::MemberDecorate:
                if (words[2] == decoration_non_writable) ++non_writable_members_[words[0]];
                break;
            case op::Constant:
            case op::SpecConstant:
                constants_[words[1]] = value_of(words[1], words[2]);
                break;
            case op::ConstantComposite:
            case op::SpecConstantComposite:
                if (words[1] == workgroup_) workgroup_ids_.assign(words.begin() + 2, words.end());
                break;
            case op::Variable:
                variables_.push_back({words[1], words[0], words[2]});
                break;
            case op::TypeBool:
            case op::TypeInt:
            case op::TypeFloat:
            case op::TypeVector:
            case op::TypeMatrix:
            case op::TypeImage:
            case op::TypeArray:
            case op::TypeStruct:
            case op::TypePointer:
                types_[words[0]] = {opcode, {words.begin() + 1, words.end()}};
                break;
            default:
                break;
        }
    }

    std::uint32_t value_of(std::uint32_t id, std::uint32_t written) const {
        const auto spec = spec_ids_.find(id);
        if (spec == spec_ids_.end()) return written;
        const auto given = specialization_.find(spec->second);
        return given == specialization_.end() ? written : given->second;
    }

    std::uint32_t bytes_of(std::uint32_t id) {
        const Type& type = types_[id];
        switch (type.opcode) {
            case op::TypeBool:
                return 4;
            case op::TypeInt:
            case op::TypeFloat:
                return type.operands[0] / 8;
            case op::TypeVector:
            case op::TypeMatrix:
                return bytes_of(type.operands[0]) * type.operands[1];
            case op::TypeArray:
                return bytes_of(type.operands[0]) * constants_[type.operands[1]];
            case op::TypeStruct: {
                std::uint32_t bytes = 0;
                for (const std::uint32_t member : type.operands) bytes += bytes_of(member);
                return bytes;
            }
            default:
                return 0;
        }
    }

    void count(const Variable& variable) {
        std::uint32_t pointee = types_[variable.pointer].operands[1], copies = 1;
        if (variable.storage == class_workgroup) {
            facts_.shared_bytes += bytes_of(pointee);
            return;
        }
        if (types_[pointee].opcode == op::TypeArray) {
            copies = constants_[types_[pointee].operands[1]];
            pointee = types_[pointee].operands[0];
        }
        const Type& type = types_[pointee];
        bool is_written = !non_writable_.contains(variable.id);
        if (variable.storage == class_storage_buffer) {
            facts_.storage_buffers += copies;
            is_written = is_written && non_writable_members_[pointee] < type.operands.size();
        } else if (variable.storage == class_uniform_constant && type.opcode == op::TypeImage &&
                   type.operands[5] == image_is_storage) {
            facts_.storage_images += copies;
        } else {
            return;
        }
        if (is_written) facts_.written += copies;
    }

    const std::map<std::uint32_t, std::uint32_t>& specialization_;
    ShaderFacts facts_;
    std::map<std::uint32_t, Type> types_;
    std::map<std::uint32_t, std::uint32_t> constants_, spec_ids_, non_writable_members_;
    std::set<std::uint32_t> non_writable_;
    std::vector<Variable> variables_;
    std::vector<std::uint32_t> workgroup_ids_;
    std::uint32_t workgroup_ = 0;
};

}  // namespace

ShaderFacts read_shader(std::span<const std::uint32_t> words,
                        const std::map<std::uint32_t, std::uint32_t>& specialization) {
    return Reader(specialization).read(words);
}

}  // namespace darkroom::gpu::test
