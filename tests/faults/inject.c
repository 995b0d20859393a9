/* Runs a command and lets one of its calls that change files below a folder fail, or kills it there.
 *
 *   inject FOLDER AT FAULT LOG COMMAND [ARGUMENT ..]
 *
 * AT counts from 1 over all threads and child processes; 0 lets all pass. FAULT is ENOSPC, EIO or KILL. LOG gets a line for each call: its number, its name, its
 * path. Of calls that the kernel makes under way only these are stopped (a seccomp filter), so that the command is hardly slower. Exit code: that of the
 * command, 128 and the signal of one that was killed, 125 where this itself fails.
 *
 * The calls are taken at the kernel's door, not in the C library: Rust's crates do not all go through it.
 */
#define _GNU_SOURCE
#include <errno.h>
#include <fcntl.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <signal.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/ptrace.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <sys/user.h>
#include <sys/wait.h>
#include <unistd.h>

/* Where a call's path stands: an argument that is a path, with the folder that it is from, or an open file. */
enum kind { OPEN, PATH, AT_PATH, FILE_NUMBER, TWO_PATHS, TWO_AT_PATHS };

static const struct call { long number; const char *name; enum kind kind; } calls[] = {
    {SYS_open, "open", OPEN},           {SYS_openat, "open", AT_PATH},     {SYS_creat, "open", PATH},
    {SYS_write, "write", FILE_NUMBER},  {SYS_writev, "write", FILE_NUMBER}, {SYS_pwrite64, "write", FILE_NUMBER},
    {SYS_fsync, "fsync", FILE_NUMBER},  {SYS_fdatasync, "fsync", FILE_NUMBER}, {SYS_ftruncate, "truncate", FILE_NUMBER},
    {SYS_copy_file_range, "copy", FILE_NUMBER}, {SYS_sendfile, "write", FILE_NUMBER}, {SYS_fallocate, "write", FILE_NUMBER},
    {SYS_rename, "rename", TWO_PATHS},  {SYS_renameat, "rename", TWO_AT_PATHS}, {SYS_renameat2, "rename", TWO_AT_PATHS},
    {SYS_link, "link", TWO_PATHS},      {SYS_linkat, "link", TWO_AT_PATHS},
    {SYS_mkdir, "mkdir", PATH},         {SYS_mkdirat, "mkdir", AT_PATH},
    {SYS_unlink, "unlink", PATH},       {SYS_unlinkat, "unlink", AT_PATH},  {SYS_rmdir, "unlink", PATH},
};
#define COUNT (sizeof calls / sizeof *calls)

static const char *folder;

static void fail(const char *what) {
    fprintf(stderr, "inject: %s: %s\n", what, strerror(errno));
    exit(125);
}

static void read_text(pid_t process, unsigned long address, char *text, size_t size) {
    size_t done = 0;
    memset(text, 0, size);
    /* Page by page: the one behind need not be there. */
    while (done + 1 < size) {
        size_t length = 4096 - (address + done) % 4096;
        if (length > size - 1 - done) length = size - 1 - done;
        struct iovec own = {text + done, length}, its = {(void *)(address + done), length};
        ssize_t read = process_vm_readv(process, &own, 1, &its, 1, 0);
        if (read <= 0 || memchr(text + done, 0, read)) return;
        done += read;
    }
}

static void link_of(pid_t process, const char *what, long number, char *text, size_t size) {
    char name[64];
    if (number >= 0) snprintf(name, sizeof name, "/proc/%d/fd/%ld", process, number);
    else snprintf(name, sizeof name, "/proc/%d/%s", process, what);
    ssize_t length = readlink(name, text, size - 1);
    text[length < 0 ? 0 : length] = 0;
}

/* A path in full. */
static void path_of(pid_t process, int from, unsigned long address, char *text, size_t size) {
    char name[4096], base[4096] = "";
    read_text(process, address, name, sizeof name);
    if (name[0] != '/') link_of(process, "cwd", from == AT_FDCWD ? -1 : from, base, sizeof base);
    snprintf(text, size, "%s%s%s", base, base[0] ? "/" : "", name);
}

static int is_below(const char *path) { return strncmp(path, folder, strlen(folder)) == 0; }

/* Whether a call changes something below the folder; its path. */
static int concerns(pid_t process, const struct call *call, const struct user_regs_struct *regs, char *path, size_t size) {
    switch (call->kind) {
    case OPEN:
        path_of(process, AT_FDCWD, regs->rdi, path, size);
        return (regs->rsi & O_CREAT) && is_below(path);
    case PATH:
        path_of(process, AT_FDCWD, regs->rdi, path, size);
        return is_below(path);
    case AT_PATH:
        path_of(process, (int)regs->rdi, regs->rsi, path, size);
        return (call->number != SYS_openat || (regs->rdx & O_CREAT)) && is_below(path);
    case FILE_NUMBER:
        /* Of a copy the file that is written to. */
        link_of(process, "", call->number == SYS_copy_file_range ? (long)regs->rdx : (long)(int)regs->rdi, path, size);
        return is_below(path);
    case TWO_PATHS:
        path_of(process, AT_FDCWD, regs->rsi, path, size);
        return is_below(path);
    case TWO_AT_PATHS:
        path_of(process, (int)regs->rdx, regs->r10, path, size);
        return is_below(path);
    }
    return 0;
}

static void begin(char **command) {
    struct sock_filter filter[COUNT + 5];
    size_t at = 0;
    filter[at++] = (struct sock_filter)BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(struct seccomp_data, nr));
    for (size_t i = 0; i < COUNT; i++)
        filter[at++] = (struct sock_filter)BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, calls[i].number, COUNT - i, 0);
    filter[at++] = (struct sock_filter)BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW);
    filter[at++] = (struct sock_filter)BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_TRACE);
    struct sock_fprog program = {at, filter};
    if (ptrace(PTRACE_TRACEME, 0, 0, 0)) fail("ptrace");
    raise(SIGSTOP);
    if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0)) fail("prctl");
    if (prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program)) fail("seccomp");
    execvp(command[0], command);
    fail(command[0]);
}

int main(int count, char **words) {
    if (count < 6) {
        fprintf(stderr, "inject FOLDER AT FAULT LOG COMMAND [ARGUMENT ..]\n");
        return 125;
    }
    folder = words[1];
    const long at = atol(words[2]);
    const int fault = strcmp(words[3], "ENOSPC") == 0 ? ENOSPC : strcmp(words[3], "EIO") == 0 ? EIO : 0;
    FILE *log = fopen(words[4], "w");
    if (!log) fail(words[4]);
    const pid_t first = fork();
    if (first == 0) begin(words + 5);
    int status;
    if (waitpid(first, &status, 0) != first || !WIFSTOPPED(status)) fail("the command");
    const long options = PTRACE_O_TRACESECCOMP | PTRACE_O_TRACECLONE | PTRACE_O_TRACEFORK | PTRACE_O_TRACEVFORK | PTRACE_O_EXITKILL;
    if (ptrace(PTRACE_SETOPTIONS, first, 0, options)) fail("ptrace");
    ptrace(PTRACE_CONT, first, 0, 0);
    long number = 0;
    int code = 125;
    pid_t process;
    while ((process = waitpid(-1, &status, __WALL)) > 0) {
        if (WIFEXITED(status) || WIFSIGNALED(status)) {
            if (process == first) code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
            continue;
        }
        int signal = WSTOPSIG(status);
        const int event = status >> 16;
        if (event == PTRACE_EVENT_SECCOMP) {
            struct user_regs_struct regs;
            char path[8300];
            if (ptrace(PTRACE_GETREGS, process, 0, &regs)) continue;
            for (size_t i = 0; i < COUNT; i++) {
                if (calls[i].number != (long)regs.orig_rax || !concerns(process, &calls[i], &regs, path, sizeof path)) continue;
                number++;
                fprintf(log, "%ld %s %s\n", number, calls[i].name, path);
                fflush(log);
                if (number == at && fault == 0) {
                    kill(process, SIGKILL);
                    kill(first, SIGKILL);
                }
                if (number == at && fault != 0) {
                    /* Passed over, with an answer. */
                    regs.orig_rax = -1;
                    regs.rax = -fault;
                    ptrace(PTRACE_SETREGS, process, 0, &regs);
                }
                break;
            }
        }
        /* Stops of the tracing itself are no signals to the command; a new thread begins with a stop. */
        if (event || signal == SIGSTOP || signal == SIGTRAP) signal = 0;
        ptrace(PTRACE_CONT, process, 0, signal);
    }
    fclose(log);
    return code;
}
