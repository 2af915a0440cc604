#include "tests/support/run_program.h"

#include "tests/support/file_bytes.h"
#include "tests/support/temporary_folder.h"

#include <csignal>
#include <fcntl.h>
#include <spawn.h>
#include <stdexcept>
#include <sys/wait.h>
#include <unistd.h>

namespace rapport::tests {

ProgramRun run_program(const std::vector<std::string>& arguments, const std::string& folder) {
    return run_executable(RAPPORT_PROGRAM, arguments, folder);
}

ProgramRun run_executable(const std::string& program, const std::vector<std::string>& arguments,
                          const std::string& folder) {
    const TemporaryFolder streams;
    const std::string out = (streams / "out").string(), err = (streams / "err").string();
    std::vector<char*> argv{const_cast<char*>(program.c_str())};
    for (const std::string& argument : arguments)
        argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);

    const pid_t child = fork();
    if (child < 0)
        throw std::runtime_error("cannot start " + program);
    if (child == 0) {
        const int flags = O_WRONLY | O_CREAT | O_TRUNC;
        if (dup2(open(out.c_str(), flags, 0600), STDOUT_FILENO) < 0 ||
            dup2(open(err.c_str(), flags, 0600), STDERR_FILENO) < 0 || chdir(folder.c_str()) != 0)
            _exit(126);
        execvp(argv[0], argv.data());
        _exit(127);
    }
    int status = 0;
    waitpid(child, &status, 0);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status), read_bytes(out),
            read_bytes(err)};
}

bool run_and_kill_program(std::vector<std::string> arguments, unsigned after) {
    arguments.insert(arguments.begin(), RAPPORT_PROGRAM);
    arguments.push_back("--quiet");
    std::vector<char*> argv;
    for (std::string& argument : arguments)
        argv.push_back(argument.data());
    argv.push_back(nullptr);
    pid_t child = 0;
    if (posix_spawn(&child, RAPPORT_PROGRAM, nullptr, nullptr, argv.data(), environ) != 0)
        throw std::runtime_error("cannot start " RAPPORT_PROGRAM);
    if (after > 0) {
        usleep(after);
        kill(child, SIGKILL);
    }
    int status = 0;
    waitpid(child, &status, 0);
    if (!WIFSIGNALED(status) && WEXITSTATUS(status) != 0)
        throw std::runtime_error(arguments[1] + " failed");
    return WIFSIGNALED(status);
}

} // namespace rapport::tests
