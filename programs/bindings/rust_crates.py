# SPDX-License-Identifier: MIT
"""Darkroom for Rust as two crates: darkroom-sys, the functions of C, and darkroom, which owns its objects. What the types
say makes a function safe: it takes numbers, texts, slices and objects. Where it takes what Vulkan or the host vouches for,
it is unsafe."""

import rust
from api import safe_name
from rust import docs

# `count` is of what they hold, and not of these.
NO_SLICES = {("DarkroomLight", "cascades")}
# Null where nothing is said.
OPTIONAL = {("darkroom_composer_fire", "time")}
SHARED = {"DarkroomDevice"}

WORKSPACE = """[workspace]
members = ["darkroom-sys", "darkroom"]
resolver = "2"
"""

MANIFEST = """[package]
name = "{name}"
version = "{version}"
edition = "2021"
rust-version = "1.82"
license = "MIT"
description = "{description}"
keywords = ["vulkan", "post-processing", "graphics"]
categories = ["graphics", "rendering"]
readme = "README.md"
{more}"""

BUILD = """// Where libdarkroom.so is: in the folder DARKROOM_LIB_DIR, or where pkg-config says; else in the system's.
fn main() {
    println!("cargo:rerun-if-env-changed=DARKROOM_LIB_DIR");
    println!("cargo:rerun-if-env-changed=PKG_CONFIG_PATH");
    if let Ok(folder) = std::env::var("DARKROOM_LIB_DIR") {
        println!("cargo:rustc-link-search=native={folder}");
        return;
    }
    let asked = std::process::Command::new("pkg-config").args(["--libs-only-L", "darkroom"]).output();
    let text = asked.map(|told| String::from_utf8_lossy(&told.stdout).into_owned()).unwrap_or_default();
    for folder in text.split_whitespace().filter_map(|word| word.strip_prefix("-L")) {
        println!("cargo:rustc-link-search=native={folder}");
    }
}
"""

README = """# {name}

{description}. Made for Darkroom {version}, of whose interface in C it has every function. It needs `libdarkroom.so` of the
same major and minor version: installed, found by pkg-config, or in the folder that `DARKROOM_LIB_DIR` names.
"""

HEAD = '''//! Darkroom: a stack of effects that turns an HDR frame into a finished picture inside the host's own Vulkan command
//! buffer. Objects own what the library gave, and end it when they go. What is handed over is described by structs that
//! are set up in a row, as those of `ash` are; zero is the default. Constants are in [`sys`].
//!
//! ```no_run
//! # fn stack() -> Result<(), darkroom::Error> {
//! let device = darkroom::Device::assumed(darkroom::sys::DARKROOM_DEVICE_PROFILE_GPU)?;
//! let composer = darkroom::Composer::create(&device, &Default::default())?;
//! let bloom = composer.add(c"bloom", &darkroom::EntryDesc::default().opacity(0.5))?;
//! composer.set_number(bloom, c"intensity", 0.1)?;
//! # Ok(())
//! # }
//! ```

#![allow(clippy::too_many_arguments, clippy::type_complexity, clippy::should_implement_trait)]

pub use darkroom_sys as sys;
use std::ffi::{c_char, c_void, CStr};
use std::marker::PhantomData;

/// What a call that failed says, in one line: function, thing, value, what is allowed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Error {
    /// Who has to act: `sys::DARKROOM_ERROR_...`.
    pub result: sys::DarkroomResult,
    pub text: String,
}
impl std::fmt::Display for Error {
    fn fmt(&self, to: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        to.write_str(&self.text)
    }
}
impl std::error::Error for Error {}

fn owned(text: *const c_char) -> Option<String> {
    // A text of the library's is valid until the next call, and ends with 0.
    (!text.is_null()).then(|| unsafe { CStr::from_ptr(text) }.to_string_lossy().into_owned())
}
fn check(result: sys::DarkroomResult) -> Result<(), Error> {
    if result == sys::DARKROOM_OK {
        return Ok(());
    }
    Err(Error { result, text: owned(unsafe { sys::darkroom_error() }).unwrap_or_default() })
}

/// An effect of the library, or of the object that gave it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Effect<'a>(sys::DarkroomEffect, PhantomData<&'a ()>);
// It is only read.
unsafe impl Send for Effect<'_> {}
unsafe impl Sync for Effect<'_> {}
'''


def short(name):
    return name.removeprefix("Darkroom")


def name_of(name):
    return safe_name(name, rust.KEYWORDS, "r#{}")


def words_of(handle):
    return "".join("_" + c.lower() if c.isupper() else c for c in short(handle)).strip("_")


class Writer:
    def __init__(self, api):
        self.api = api
        self.structs = {struct.name: struct for struct in api.structs}
        self.handles = {row["name"] for row in api.handles}
        # The longest first: "composer" is no begin of another, but effects of a file are "custom_effect".
        self.groups = {f"darkroom_{words_of(handle)}_": handle for handle in sorted(self.handles, key=len, reverse=True)}

    def base(self, name):
        """A type of Rust for one without pointers."""
        kind = self.api.kinds[name]
        if name == "VkBool32":
            return "bool"
        if kind in ("alias", "enum", "callback") and not name.startswith("Vk") or kind == "struct" and name.startswith("Vk"):
            return f"sys::{name}"
        return rust.base_type(self.api, name)

    def is_number(self, type):
        return self.api.kinds[type.name] in ("c", "alias", "integer", "enum") and type.name not in ("void", "char")

    def inputs(self):
        """What functions are given, and what that points to."""
        out, new = set(), {parameter.type.name for function in self.api.functions for parameter in function.parameters
                           if parameter.type.pointers == ["const"]}
        while new := {name for name in new if name in self.structs} - out:
            out |= new
            new = {member.type.name for name in new for member in self.structs[name].members}
        return [struct for struct in self.api.structs if struct.name in out]

    def has_pointers(self, struct):
        return any(member.type.pointers for member in struct.members)

    def of_struct(self, name, lifetime="'_"):
        return short(name) + (f"<{lifetime}>" if self.has_pointers(self.structs[name]) else "")

    def names_vulkan(self, name, seen=()):
        """Whether a struct has a handle of Vulkan's, in itself or in what it points to."""
        if name not in self.structs or name in seen:
            return False
        return any(self.api.kinds[member.type.name] in ("object", "function") or
                   (self.api.kinds[member.type.name] == "handle" and member.type.name.startswith("Vk")) or
                   self.names_vulkan(member.type.name, (*seen, name)) for member in self.structs[name].members)

    # ---- structs

    def count_of(self, struct, member):
        names = {one.name for one in struct.members}
        if (struct.name, member.name) in NO_SLICES or len(member.type.pointers) == 0 or member.type.is_text():
            return None
        wanted = (f"{member.name}_count", f"{member.name[:-1]}_count", f"{member.name}_size")
        return next((name for name in wanted if name in names and
                     (name.endswith("_count") or member.type.name == "void")), None)

    def setter(self, struct, member):
        type, name = member.type, member.name
        kind = self.api.kinds[type.name]
        # A word of its own where the setter is called as a function of all is.
        head, take, put, is_unsafe = f"pub fn {name_of(name)}", "", "", False
        count = self.count_of(struct, member)
        if type.is_text():
            take, put = "&'a CStr", "value.as_ptr()"
        elif count and type.name in self.structs:
            take, put = f"&'a [{self.of_struct(type.name, chr(39) + 'a')}]", "value.as_ptr().cast()"
        elif count and type.name == "void":
            take, put = "&'a [u8]", "value.as_ptr().cast()"
        elif count and len(type.pointers) == 1 and self.is_number(type):
            take, put = f"&'a [{self.base(type.name)}]", "value.as_ptr()"
        elif type.pointers and type.name in self.structs:
            take, put, count = f"&'a {self.of_struct(type.name, chr(39) + 'a')}", "&value.0", None
        elif type.pointers:
            is_unsafe, take, put, count = True, self.raw(type), "value", None
        elif kind in ("callback", "function"):
            is_unsafe, take, put = kind == "callback", self.base(type.name), "value"
        elif type.length:
            take, put = f"[{self.base(type.name)}; {type.length}]", "value"
        else:
            take, put = self.base(type.name), "value.into()" if type.name == "VkBool32" else "value"
        safety = (f"{'    ///' + chr(10) if member.doc else ''}    /// # Safety\n    /// What it points to is as the struct says, for as long as the library may use it.\n"
                  if is_unsafe else "")
        lines = f"        self.0.{name_of(name)} = {put};\n"
        if count:
            kind = "usize" if count.endswith("_size") else "u32"
            lines += f"        self.0.{count} = value.len(){'' if kind == 'usize' else ' as u32'};\n"
        return (f"{docs(member.doc, '    ')}{safety}    {head.replace('pub fn', 'pub unsafe fn') if is_unsafe else head}"
                f"(mut self, value: {take}) -> Self {{\n{lines}        self\n    }}\n")

    def raw(self, type):
        out = self.base(type.name) if type.name not in self.structs else f"sys::{type.name}"
        for pointer in type.pointers:
            out = f"*{'const' if pointer == 'const' else 'mut'} {out}"
        return out

    def struct_text(self, struct):
        mark = "<'a>" if self.has_pointers(struct) else ""
        field = ", PhantomData<&'a ()>" if mark else ""
        counts = {self.count_of(struct, member) for member in struct.members}
        setters = "".join(self.setter(struct, member) for member in struct.members
                          if member.name != "struct_size" and member.name not in counts)
        return (f"\n{docs(struct.doc)}#[derive(Clone, Copy, Default)]\n#[repr(transparent)]\n"
                f"pub struct {short(struct.name)}{mark}(sys::{struct.name}{field});\n"
                f"impl{mark} {short(struct.name)}{mark} {{\n{setters}}}\n")

    # ---- functions

    def function_text(self, function, group):
        api = self.api
        parameters = list(function.parameters)
        name = function.short_name() if group is None else function.name.removeprefix(
            next(begin for begin, handle in self.groups.items() if handle == group))
        takes, gives, arguments, before, after, lists = [], [], [], [], [], []
        is_unsafe = False
        if group is not None and parameters and parameters[0].type.name == group and not parameters[0].type.pointers:
            takes.append("self" if group == "DarkroomEffect" else "&self")
            arguments.append("self.0")
            parameters = parameters[1:]
        skip = None
        for i, one in enumerate(parameters):
            type, word = one.type, name_of(one.name)
            after_this = parameters[i + 1] if i + 1 < len(parameters) else None
            is_list = after_this is not None and after_this.name == "count"
            if one is skip:
                continue
            if not type.pointers and type.name in self.handles:
                takes.append(f"{word}: {'Effect<' + chr(39) + '_>' if type.name == 'DarkroomEffect' else '&' + short(type.name)}")
                arguments.append(f"{word}.0")
            elif not type.pointers:
                kind = api.kinds[type.name]
                is_unsafe |= kind in ("handle", "object")
                takes.append(f"{word}: {self.base(type.name)}")
                arguments.append(f"{word}.into()" if type.name == "VkBool32" else word)
            elif type.is_text():
                takes.append(f"{word}: &CStr")
                arguments.append(f"{word}.as_ptr()")
            elif type.pointers == ["const"] and type.name in self.structs:
                is_unsafe |= self.names_vulkan(type.name)
                takes.append(f"{word}: &{self.of_struct(type.name)}")
                arguments.append(f"&{word}.0")
            elif type.pointers == ["const"] and type.length:
                takes.append(f"{word}: &[{self.base(type.name)}; {type.length}]")
                arguments.append(f"{word}.as_ptr()")
            elif type.pointers == ["const"] and is_list and not after_this.type.pointers:
                takes.append(f"{word}: &[{self.base(type.name)}]")
                arguments += [f"{word}.as_ptr()", f"{word}.len() as u32"]
                skip = after_this
            elif type.pointers == ["const"] and (function.name, one.name) in OPTIONAL:
                takes.append(f"{word}: Option<{self.base(type.name)}>")
                arguments.append(f"{word}.as_ref().map_or(std::ptr::null(), |value| value)")
            elif type.pointers == ["const"]:
                is_unsafe = True
                takes.append(f"{word}: {self.raw(type)}")
                arguments.append(word)
            elif type.name == "char":
                before.append(f"let mut {word}: *const c_char = std::ptr::null();")
                arguments.append(f"&mut {word}")
                gives.append(("String", f"owned({word}).unwrap_or_default()"))
            elif type.name == "void":
                # Bytes and their size.
                before.append(f"let (mut {word}, mut {after_this.name}) = (std::ptr::null::<c_void>(), 0);")
                arguments += [f"&mut {word}", f"&mut {after_this.name}"]
                after.append(f"let {word} = if {word}.is_null() {{ Vec::new() }} else {{ unsafe {{ "
                             f"std::slice::from_raw_parts({word}.cast::<u8>(), {after_this.name}) }}.to_vec() }};")
                gives.append(("Vec<u8>", word))
                skip = after_this
            elif is_list and after_this.type.pointers:
                element = f"sys::{type.name}" if type.name in self.structs else self.base(type.name)
                lists.append((word, element))
                before.append(f"let mut count = 0u32;\n        let mut {word}: Vec<{element}> = Vec::new();")
                arguments += [f"if {word}.is_empty() {{ std::ptr::null_mut() }} else {{ {word}.as_mut_ptr() }}", "&mut count"]
                after.append(f"{word}.truncate(count as usize);")
                gives.append((f"Vec<{element}>", word))
                skip = after_this
            elif type.length:
                before.append(f"let mut {word} = [{'0 as ' + self.base(type.name)}; {type.length}];")
                arguments.append(f"{word}.as_mut_ptr()")
                gives.append((f"[{self.base(type.name)}; {type.length}]", word))
            elif type.name == "DarkroomEffect":
                # That of a file goes with its object, and with the entries that hold it.
                is_unsafe = True
                before.append(f"let mut {word} = std::ptr::null_mut();")
                arguments.append(f"&mut {word}")
                gives.append(("Effect<'_>", f"Effect({word}, PhantomData)"))
            elif type.name in self.handles:
                before.append(f"let mut {word} = std::ptr::null_mut();")
                arguments.append(f"&mut {word}")
                gives.append((short(type.name), f"{short(type.name)}({word})"))
            elif type.name in self.structs:
                before.append(f"let mut {word} = sys::{type.name}::default();")
                arguments.append(f"&mut {word}")
                gives.append((f"sys::{type.name}", word))
            elif type.name == "VkBool32":
                before.append(f"let mut {word} = 0;")
                arguments.append(f"&mut {word}")
                gives.append(("bool", f"{word} != 0"))
            else:
                before.append(f"let mut {word}: {self.base(type.name)} = Default::default();")
                arguments.append(f"&mut {word}")
                gives.append((self.base(type.name), word))

        call = f"unsafe {{ sys::{function.name}({', '.join(arguments)}) }}"
        if function.can_fail:
            calls = [f"check({call})?;"]
        elif function.result.is_void():
            calls = [f"{call};"]
        elif function.result.is_text():
            calls, gives = [], [("Option<String>", f"owned({call})")]
        elif function.result.name == "DarkroomEffect":
            lifetime = "'_" if "&self" in takes else "'static"
            calls = [f"let effect = {call};"]
            gives = [(f"Option<Effect<{lifetime}>>", "(!effect.is_null()).then_some(Effect(effect, PhantomData))")]
        else:
            calls, gives = [], [(self.base(function.result.name), call)]
        for word, element in lists:
            # Once for how many there are, once for them.
            calls = [*calls, f"if count > 0 {{\n            {word} = vec![Default::default(); count as usize];\n"
                             f"            {calls[0]}\n        }}"]
        value = gives[0][1] if len(gives) == 1 else f"({', '.join(one for _, one in gives)})"
        result = gives[0][0] if len(gives) == 1 else f"({', '.join(one for one, _ in gives)})"
        if function.can_fail:
            value, result = f"Ok({value})", f"Result<{result}, Error>"
        safety = ("    ///\n    /// # Safety\n    /// What is handed over is Vulkan's or the host's, and as `darkroom.h` says. The composer goes when its\n"
                  "    /// recordings have finished, and what a device was adopted with outlives all that was made on it. An effect of\n"
                  "    /// a file is used while its entry is there.\n" if is_unsafe else "")
        body = "".join(f"        {line}\n" for line in [*before, *calls, *after] + ([value] if value != "()" else []))
        arrow = f" -> {result}" if result != "()" else ""
        return (f"{docs(function.doc, '    ')}{safety}    pub {'unsafe ' if is_unsafe else ''}fn {name_of(name)}"
                f"({', '.join(takes)}){arrow} {{\n{body}    }}\n")

    def object_text(self, handle, functions):
        doc = next(row["doc"] for row in self.api.handles if row["name"] == handle)
        methods = "".join(self.function_text(function, handle) for function in functions)
        if handle == "DarkroomEffect":
            return f"\nimpl<'a> Effect<'a> {{\n{methods}}}\n"
        shared = f"// Its functions may be called by several threads at once.\nunsafe impl Sync for {short(handle)} {{}}\n"
        return (f"\n{docs(doc) or docs('An object of the library: used by one thread at a time, whichever that is.')}"
                f"#[derive(Debug)]\npub struct {short(handle)}(sys::{handle});\nunsafe impl Send for {short(handle)} {{}}\n"
                f"{shared if handle in SHARED else ''}"
                f"impl Drop for {short(handle)} {{\n    fn drop(&mut self) {{\n"
                f"        unsafe {{ sys::darkroom_{words_of(handle)}_destroy(self.0) }}\n    }}\n}}\n"
                f"impl {short(handle)} {{\n{methods}}}\n")

    def library(self):
        out = [self.api.head("Rust", "//"), HEAD]
        out += [f"\n{docs(row['doc'])}pub type {short(row['name'])} = sys::{row['name']};\n" for row in self.api.aliases]
        out += [self.struct_text(struct) for struct in self.inputs()]
        grouped = {handle: [] for handle in self.handles}
        free = []
        for function in self.api.functions:
            begin = next((begin for begin in self.groups if function.name.startswith(begin)), None)
            if function.name in ("darkroom_error",) or function.name.endswith("_destroy"):
                continue
            (free if begin is None else grouped[self.groups[begin]]).append(function)
        out += [self.object_text(handle, grouped[handle]) for handle in sorted(grouped)]
        # Functions of nothing stand at the margin.
        out += ["\n" + "\n".join(line.removeprefix("    ") for line in self.function_text(function, None).split("\n"))
                for function in free]
        return "".join(out)


def write(api):
    about = {"darkroom-sys": "Post-processing for Vulkan: the functions of libdarkroom in C",
             "darkroom": "Post-processing for Vulkan: a stack of effects inside the host's own command buffer"}
    more = {"darkroom-sys": 'links = "darkroom"\nbuild = "build.rs"\n',
            "darkroom": f'\n[dependencies]\ndarkroom-sys = {{ version = "{api.version}", path = "../darkroom-sys" }}\n'}
    files = {"Cargo.toml": WORKSPACE, "darkroom-sys/build.rs": BUILD, "darkroom-sys/src/lib.rs": rust.write(api),
             "darkroom/src/lib.rs": Writer(api).library()}
    for name, description in about.items():
        values = {"name": name, "version": api.version, "description": description, "more": more[name]}
        files[f"{name}/Cargo.toml"] = MANIFEST.format(**values)
        files[f"{name}/README.md"] = README.format(**values)
    return files
