// SPDX-License-Identifier: MIT
#include "confined/inside/confine.hpp"

#include <fcntl.h>
#include <linux/landlock.h>
#include <sched.h>
#include <seccomp.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <memory>
#include <string_view>

#include "confined/messages.hpp"

namespace darkroom {
namespace {

// Landlock's first version: all that opens, makes, moves or runs a file. Later versions are asked for no more.
constexpr std::uint64_t to_read = LANDLOCK_ACCESS_FS_READ_FILE | LANDLOCK_ACCESS_FS_READ_DIR;
constexpr std::uint64_t all_access = (LANDLOCK_ACCESS_FS_MAKE_SYM << 1) - 1;

bool confine_files(const std::vector<std::string>& readable_folders) {
    const landlock_ruleset_attr rules{.handled_access_fs = all_access};
    const auto ruleset = static_cast<int>(syscall(SYS_landlock_create_ruleset, &rules, sizeof rules, 0));
    if (ruleset < 0) return false;
    for (const std::string& folder : readable_folders) {
        const int opened = open(folder.c_str(), O_PATH | O_CLOEXEC | O_DIRECTORY);
        if (opened < 0) continue;
        const landlock_path_beneath_attr rule{.allowed_access = to_read, .parent_fd = opened};
        syscall(SYS_landlock_add_rule, ruleset, LANDLOCK_RULE_PATH_BENEATH, &rule, 0);
        close(opened);
    }
    const bool is_done = syscall(SYS_landlock_restrict_self, ruleset, 0) == 0;
    close(ruleset);
    return is_done;
}

// What is not named here fails as something that is not permitted, which libraries take for an answer.
bool confine_calls(bool opens_files) {
    const std::unique_ptr<void, decltype(&seccomp_release)> filter(seccomp_init(SCMP_ACT_ERRNO(EPERM)),
                                                                   seccomp_release);
    if (filter == nullptr) return false;
    constexpr std::array allowed{
        // what is open, and its memory
        SCMP_SYS(read), SCMP_SYS(readv), SCMP_SYS(pread64), SCMP_SYS(write), SCMP_SYS(writev), SCMP_SYS(lseek),
        SCMP_SYS(close), SCMP_SYS(fcntl), SCMP_SYS(recvfrom), SCMP_SYS(recvmsg), SCMP_SYS(sendto), SCMP_SYS(poll),
        SCMP_SYS(ppoll), SCMP_SYS(mmap), SCMP_SYS(mprotect), SCMP_SYS(munmap), SCMP_SYS(mremap), SCMP_SYS(madvise),
        SCMP_SYS(brk), SCMP_SYS(eventfd2), SCMP_SYS(fstat),
        // threads, their locks and their end
        SCMP_SYS(futex), SCMP_SYS(set_robust_list), SCMP_SYS(rseq), SCMP_SYS(set_tid_address), SCMP_SYS(gettid),
        SCMP_SYS(sched_yield), SCMP_SYS(sched_getaffinity), SCMP_SYS(sched_getparam), SCMP_SYS(sched_getscheduler),
        SCMP_SYS(membarrier), SCMP_SYS(exit), SCMP_SYS(exit_group), SCMP_SYS(arch_prctl),
        // signals, time and numbers
        SCMP_SYS(rt_sigaction), SCMP_SYS(rt_sigprocmask), SCMP_SYS(rt_sigreturn), SCMP_SYS(sigaltstack),
        SCMP_SYS(restart_syscall), SCMP_SYS(alarm), SCMP_SYS(setitimer), SCMP_SYS(clock_gettime),
        SCMP_SYS(clock_getres), SCMP_SYS(clock_nanosleep), SCMP_SYS(nanosleep), SCMP_SYS(gettimeofday), SCMP_SYS(time),
        SCMP_SYS(getrandom), SCMP_SYS(uname), SCMP_SYS(sysinfo), SCMP_SYS(getpid), SCMP_SYS(getuid), SCMP_SYS(geteuid),
        SCMP_SYS(getgid), SCMP_SYS(getegid), SCMP_SYS(getrlimit)};
    constexpr std::array of_files{SCMP_SYS(newfstatat), SCMP_SYS(stat),       SCMP_SYS(lstat),      SCMP_SYS(statx),
                                  SCMP_SYS(access),     SCMP_SYS(faccessat),  SCMP_SYS(faccessat2), SCMP_SYS(readlink),
                                  SCMP_SYS(readlinkat), SCMP_SYS(getdents64), SCMP_SYS(statfs),     SCMP_SYS(fstatfs),
                                  SCMP_SYS(getcwd)};
    bool is_made = true;
    if (opens_files)
        for (const int call : of_files)
            is_made = seccomp_rule_add(filter.get(), SCMP_ACT_ALLOW, call, 0) == 0 && is_made;
    for (const int call : allowed) is_made = seccomp_rule_add(filter.get(), SCMP_ACT_ALLOW, call, 0) == 0 && is_made;
    // Threads, but no processes. What clone3 is asked lies in memory, which a filter cannot see: the C library takes
    // clone if there is none.
    const auto add = [&](std::uint32_t action, int call, const scmp_arg_cmp& argument) {
        is_made = seccomp_rule_add(filter.get(), action, call, 1, argument) == 0 && is_made;
    };
    add(SCMP_ACT_ALLOW, SCMP_SYS(clone), {0, SCMP_CMP_MASKED_EQ, CLONE_THREAD, CLONE_THREAD});
    is_made = seccomp_rule_add(filter.get(), SCMP_ACT_ERRNO(ENOSYS), SCMP_SYS(clone3), 0) == 0 && is_made;
    // Files to read.
    constexpr std::uint64_t changes = O_ACCMODE | O_CREAT | O_TRUNC | O_APPEND;
    if (opens_files) {
        add(SCMP_ACT_ALLOW, SCMP_SYS(open), {1, SCMP_CMP_MASKED_EQ, changes, 0});
        add(SCMP_ACT_ALLOW, SCMP_SYS(openat), {2, SCMP_CMP_MASKED_EQ, changes, 0});
    }
    // Its own end.
    add(SCMP_ACT_ALLOW, SCMP_SYS(tgkill), {0, SCMP_CMP_EQ, static_cast<scmp_datum_t>(getpid()), 0});
    add(SCMP_ACT_ALLOW, SCMP_SYS(prctl), {0, SCMP_CMP_EQ, PR_SET_NAME, 0});
    // Limits to read, none to set.
    add(SCMP_ACT_ALLOW, SCMP_SYS(prlimit64), {2, SCMP_CMP_EQ, 0, 0});
    return is_made && seccomp_load(filter.get()) == 0;
}

}  // namespace

Confinement confine(const std::vector<std::string>& readable_folders) {
    const rlimit nothing{0, 0};
    setrlimit(RLIMIT_CORE, &nothing);
    // Both ask for it: nothing that is run gains rights.
    if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0) return {};
    Confinement out;
    out.has_landlock = confine_files(readable_folders);
    out.has_seccomp = confine_calls(!readable_folders.empty());
    return out;
}

std::string why_not_confined(const Confinement& done, std::span<const char* const> arguments) {
    for (const std::string_view argument : arguments)
        if (argument == allow_unconfined_flag) return {};
    return done.has_seccomp ? std::string()
                            : "cannot be confined: this kernel holds no calls back (seccomp), and only "
                              "--allow-unconfined lets it read files of strangers";
}

}  // namespace darkroom
