# SPDX-License-Identifier: MIT
"""Darkroom for Rust."""

from api import safe_name, type_in_bits

C_TYPES = {"void": "c_void", "char": "c_char", "float": "f32", "double": "f64", "int32_t": "i32", "uint32_t": "u32",
           "uint64_t": "u64", "size_t": "usize"}
KEYWORDS = set("""as async await box break const continue dyn else enum extern false final fn for gen if impl in
    let loop macro match mod move mut override priv pub ref return static struct trait true try type typeof unsafe
    use virtual where while yield""".split())

HEAD = '''//
// A module, `mod darkroom;`, for Rust 1.82 or later, in any edition. The functions of C are as they are there; those of
// `checked` return their error's text. A struct's `Default` sets its size.

#![allow(non_camel_case_types, dead_code)]

use std::ffi::CStr;
use std::os::raw::{c_char, c_void};

'''

CHECKED = '''/// A text of the library's; nothing where it is null.
///
/// # Safety
/// `text` is null or ends with 0.
pub unsafe fn text(text: *const c_char) -> Option<String> {
    if text.is_null() {
        None
    } else {
        Some(unsafe { CStr::from_ptr(text) }.to_string_lossy().into_owned())
    }
}

/// The functions that can fail. Their error is one line: place, thing, value, what is allowed.
#[allow(clippy::missing_safety_doc, clippy::too_many_arguments)]
pub mod checked {
    use super::*;

    unsafe fn check(result: DarkroomResult) -> Result<(), String> {
        if result == DARKROOM_OK {
            Ok(())
        } else {
            Err(unsafe { text(darkroom_error()) }.unwrap_or_default())
        }
    }
'''


def name_of(name):
    return safe_name(name, KEYWORDS, "r#{}")


def base_type(api, name):
    return "c_void" if api.kinds[name] == "opaque" else type_in_bits(api, name, C_TYPES, "*mut c_void")


def type_of(api, type):
    out = base_type(api, type.name)
    for pointer in type.pointers:
        out = f"*{'const' if pointer == 'const' else 'mut'} {out}"
    return f"[{out}; {type.length}]" if type.length and not type.pointers else out


def docs(doc, indent=""):
    """An interval is no link."""
    text = doc.replace("[", "\\[").replace("]", "\\]")
    return f"{indent}/// {text}\n" if doc else ""


def parameters_of(api, function):
    return ", ".join(f"{name_of(parameter.name)}: {type_of(api, parameter.type)}" for parameter in function.parameters)


def result_of(api, function):
    return "" if function.result.is_void() else f" -> {type_of(api, function.result)}"


def struct_text(api, struct):
    members = "".join(f"{docs(member.doc, '    ')}    pub {name_of(member.name)}: {type_of(api, member.type)},\n"
                      for member in struct.members)
    out = f"{docs(struct.doc, '')}#[repr(C)]\n#[derive(Clone, Copy)]\npub struct {struct.name} {{\n{members}}}\n"
    if struct.name.startswith("Vk"):
        return out + "\n"
    return out + (f"impl Default for {struct.name} {{\n    fn default() -> Self {{\n"
                  "        // Numbers, pointers and functions that may be null.\n"
                  "        let mut made: Self = unsafe { std::mem::zeroed() };\n"
                  "        made.struct_size = std::mem::size_of::<Self>() as u32;\n        made\n    }\n}\n\n")


def checked_text(api, function):
    names = ", ".join(name_of(parameter.name) for parameter in function.parameters)
    return (f"\n{docs(function.doc, '    ')}    pub unsafe fn {function.short_name()}({parameters_of(api, function)})"
            f" -> Result<(), String> {{\n        unsafe {{ check({function.name}({names})) }}\n    }}\n")


def write(api):
    out = [api.head("Rust", "//"), HEAD]
    out += [f"{docs(row['doc'], '')}pub const {row['name']}: {C_TYPES[row['type']]} = {row['value']};\n" for row in api.constants]
    for row in api.aliases:
        out.append(f"{docs(row['doc'], '')}pub type {row['name']} = {C_TYPES[row['type']]};\n")
    for row in api.handles:
        out.append(f"\n#[repr(C)]\npub struct {row['name']}Object {{\n    hidden: [u8; 0],\n}}\n"
                   f"{docs(row['doc'], '')}pub type {row['name']} = *mut {row['name']}Object;\n")
    for row in api.enums:
        # Numbers: a library that is newer may have values that an enum of Rust must not hold.
        out.append(f"\n{docs(row['doc'], '')}pub type {row['name']} = i32;\n")
        out += [f"{docs(value['doc'], '')}pub const {value['name']}: {row['name']} = {value['value']};\n"
                for value in row["values"]]
    for callback in api.callbacks:
        out.append(f"\n{docs(callback.doc, '')}pub type {callback.name} = "
                   f"Option<unsafe extern \"C\" fn({parameters_of(api, callback)}){result_of(api, callback)}>;\n")
    out.append("\n")
    out += [struct_text(api, struct) for struct in api.vulkan_structs + api.structs]
    out.append('#[link(name = "darkroom")]\nunsafe extern "C" {\n')
    for function in api.functions:
        out.append(f"{docs(function.doc, '    ')}    pub fn {function.name}({parameters_of(api, function)})"
                   f"{result_of(api, function)};\n")
    out.append("}\n\n" + CHECKED)
    out += [checked_text(api, function) for function in api.functions if function.can_fail]
    return "".join(out) + "}\n"
