# SPDX-License-Identifier: MIT
"""darkroom_load.h, for hosts in C and C++ that open the library while they run."""

# What a function of the null instance takes is not looked at, and what it gives is nothing: 0, null, an empty text, a
# list without elements.

HEAD = '''#ifndef DARKROOM_LOAD_H
#define DARKROOM_LOAD_H
// Opens libdarkroom while the program runs, for hosts that go on without it; in C99 and C++11. Such a host is not linked
// with the library:
//
//     const DarkroomInstance darkroom = darkroom_load(NULL, NULL, NULL);
//     darkroom.composer_add(composer, "bloom", NULL, &bloom);   // darkroom_composer_add() of darkroom.h
//
// Without a library that fits, darkroom_load() says so once and gives the null instance: each of its functions does
// nothing, returns DARKROOM_OK where it can fail, and gives null objects, empty texts and zeroes, so that the host needs
// no branch. record() then leaves the target as the host drew it: draw the picture that is to be shown without Darkroom
// there first, and name the layout that the target is in.

#include <darkroom/darkroom.h>
#include <stdio.h>
#include <string.h>
#if defined(_WIN32)
#ifndef WIN32_LEAN_AND_MEAN
#define WIN32_LEAN_AND_MEAN
#endif
#ifndef NOMINMAX
#define NOMINMAX
#endif
#include <windows.h>
#else
#include <dlfcn.h>
#endif

/// The functions of darkroom.h without their prefix. It is copied freely; the library stays open until the program ends.
typedef struct DarkroomInstance {
    int is_null;         ///< there is no library
    const char* reason;  ///< why; empty where there is one
'''

LOAD = '''
// ---------------------------------------------------------------------------------------------------------------------
// The library

static inline void* darkroom_load_open(const char* file) {
#if defined(_WIN32)
    wchar_t wide[4096];
    if (MultiByteToWideChar(CP_UTF8, 0, file, -1, wide, 4096) == 0) return NULL;
    return (void*)LoadLibraryW(wide);
#else
    return dlopen(file, RTLD_NOW | RTLD_LOCAL);
#endif
}

static inline void darkroom_load_close(void* library) {
#if defined(_WIN32)
    FreeLibrary((HMODULE)library);
#else
    dlclose(library);
#endif
}

/// Fills in a pointer to a function. What is missing first stays in `missing`.
static inline void darkroom_load_function(void* library, const char* name, void* pointer, const char** missing) {
#if defined(_WIN32)
    const FARPROC function = GetProcAddress((HMODULE)library, name);
#else
    void* const function = dlsym(library, name);
#endif
    if (function == NULL && *missing == NULL) *missing = name;
    memcpy(pointer, &function, sizeof function);
}

/// Keeps the reason, and says it: to `warn`, or on standard error.
static inline DarkroomInstance darkroom_load_nothing(const char* file, const char* reason, DarkroomWarn warn,
                                                     void* user) {
    snprintf(darkroom_null_reason, sizeof darkroom_null_reason, "darkroom_load: %s: %s", file, reason);
    if (warn != NULL)
        warn(user, darkroom_null_reason);
    else
        fprintf(stderr, "%s\\n", darkroom_null_reason);
    return darkroom_null_instance();
}

/// Opens `path`, or where it is null what the system finds by the library's own name. The library's major and minor
/// version have to be those of this header, as in the name of its file, and it has to have every function. `warn` gets
/// the one line that says why there is none; null: it goes to standard error.
static inline DarkroomInstance darkroom_load(const char* path, DarkroomWarn warn, void* user) {{
#if defined(_WIN32)
    const char* const file = path == NULL ? "libdarkroom.dll" : path;
#else
    const char* const file = path == NULL ? "libdarkroom.so.{soname}" : path;
#endif
    char reason[256];
    DarkroomInstance out;
    const char* missing = NULL;
    uint32_t version = 0;
    void* const library = darkroom_load_open(file);
    memset(&out, 0, sizeof out);
    out.reason = "";
    if (library == NULL) {{
#if defined(_WIN32)
        snprintf(reason, sizeof reason, "it cannot be opened, error %lu", (unsigned long)GetLastError());
        return darkroom_load_nothing(file, reason, warn, user);
#else
        // It begins with the name, mostly.
        const char* text = dlerror();
        const size_t length = strlen(file);
        if (text == NULL) text = "it cannot be opened";
        if (strncmp(text, file, length) == 0 && strncmp(text + length, ": ", 2) == 0) text += length + 2;
        return darkroom_load_nothing(file, text, warn, user);
#endif
    }}
    darkroom_load_function(library, "darkroom_version", &out.version, &missing);
    if (missing == NULL) version = out.version();
    if (missing == NULL && version / 1000 != DARKROOM_VERSION / 1000) {{
        snprintf(reason, sizeof reason, "it is version %u.%u.%u, and this program takes %u.%u", version / 1000000,
                 version / 1000 % 1000, version % 1000, DARKROOM_VERSION / 1000000u, DARKROOM_VERSION / 1000u % 1000u);
        darkroom_load_close(library);
        return darkroom_load_nothing(file, reason, warn, user);
    }}
{functions}    if (missing != NULL) {{
        snprintf(reason, sizeof reason, "it has no %s", missing);
        darkroom_load_close(library);
        return darkroom_load_nothing(file, reason, warn, user);
    }}
    return out;
}}

#endif
'''


def type_in_c(type):
    out = type.name
    for i, pointer in enumerate(type.pointers):
        if pointer == "const":
            out = f"const {out}" if i == 0 else f"{out} const"
        out += "*"
    return out


def parameters_of(function):
    return ", ".join(f"{type_in_c(one.type)} {one.name}" for one in function.parameters) or "void"


def pointer(function):
    return f"    {type_in_c(function.result)} (*{function.short_name()})({parameters_of(function)});\n"


def is_list(function, index):
    """`count` is the room in the parameter before it."""
    after = function.parameters[index + 1:index + 2]
    return bool(after) and after[0].name == "count" and after[0].type.pointers == ["mutable"]


def nothing(api, function, index):
    """What the null instance makes of a parameter that it gives something by; None: it gives nothing there."""
    parameter = function.parameters[index]
    name, type = parameter.name, parameter.type
    if not type.pointers or type.pointers[-1] != "mutable" or is_list(function, index):
        return None
    if type.name == "char":
        return f'if ({name} != NULL) *{name} = "";'
    if type.length:
        # What is changed from one array to another is left as it was.
        same = [one.name for one in function.parameters
                if one.type.name == type.name and one.type.length == type.length and one.type.pointers == ["const"]]
        size = f"{type.length} * sizeof *{name}"
        if same:
            return f"if ({name} != NULL && {same[0]} != NULL) memmove({name}, {same[0]}, {size});"
        return f"if ({name} != NULL) memset({name}, 0, {size});"
    struct = next((one for one in api.structs if one.name == type.name), None)
    if struct is None:
        return f"if ({name} != NULL) memset({name}, 0, sizeof *{name});"
    texts = "".join(f' {name}->{member.name} = "";' for member in struct.members if member.type.is_text())
    return (f"if ({name} != NULL) {{ memset((char*){name} + sizeof(uint32_t), 0, sizeof *{name} - sizeof(uint32_t));"
            f"{texts} }}")


def result(function):
    if function.result.is_void():
        return ""
    if function.name == "darkroom_error":
        return "    return darkroom_null_reason;\n"
    if function.can_fail:
        return "    return DARKROOM_OK;\n"
    # A list of texts ends with null.
    is_one = function.result.is_text() and all(parameter.name != "index" for parameter in function.parameters)
    return f"    return {chr(34) * 2 if is_one else 'NULL' if function.result.pointers else '0'};\n"


def null_function(api, function):
    given = {i: nothing(api, function, i) for i in range(len(function.parameters))}
    used = " ".join(text for text in given.values() if text)
    unused = [f"(void){one.name}" for one in function.parameters if f"{one.name} " not in used]
    unused = f"    {', '.join(unused)};\n" if unused else ""
    lines = "".join(f"    {text}\n" for text in given.values() if text)
    return (f"static inline {type_in_c(function.result)} darkroom_null_{function.short_name()}"
            f"({parameters_of(function)}) {{\n{unused}{lines}{result(function)}}}\n")


def write(api):
    out = [api.head("C", "//"), HEAD]
    out += [pointer(function) for function in api.functions]
    out.append("} DarkroomInstance;\n\n"
               "// ------------------------------------------------------------------------------------------------------"
               "---------------\n// The null instance\n\n/// Why there is no library.\n"
               "static char darkroom_null_reason[1024];\n\n")
    out += [null_function(api, function) for function in api.functions]
    out.append("\nstatic inline DarkroomInstance darkroom_null_instance(void) {\n    DarkroomInstance out;\n"
               "    out.is_null = 1;\n    out.reason = darkroom_null_reason;\n")
    out += [f"    out.{function.short_name()} = darkroom_null_{function.short_name()};\n" for function in api.functions]
    out.append("    return out;\n}\n")
    functions = "".join(f'    darkroom_load_function(library, "{function.name}", &out.{function.short_name()}, &missing);\n'
                        for function in api.functions if function.name != "darkroom_version")
    head, _, tail = LOAD.partition("/// Opens `path`")
    return "".join(out) + head + ("/// Opens `path`" + tail).format(soname=api.soname, functions=functions)
