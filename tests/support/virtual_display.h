#pragma once

#include <csignal>
#include <cstdlib>
#include <fcntl.h>
#include <stdexcept>
#include <string>
#include <sys/wait.h>
#include <unistd.h>

namespace rapport::tests {

/// A display without a screen, named by DISPLAY while this lives.
class VirtualDisplay {
  public:
    /// Whether there can be one: Debian's xvfb.
    static bool available() { return std::system("command -v Xvfb >/dev/null") == 0; }

    VirtualDisplay() {
        int ends[2];
        if (pipe(ends) != 0 || (server_ = fork()) < 0)
            throw std::runtime_error("cannot start Xvfb");
        if (server_ == 0) {
            close(ends[0]);
            const std::string number_to = std::to_string(ends[1]);
            const int nowhere = open("/dev/null", O_WRONLY);
            dup2(nowhere, STDOUT_FILENO);
            dup2(nowhere, STDERR_FILENO);
            execlp("Xvfb", "Xvfb", "-displayfd", number_to.c_str(), "-screen", "0", "1280x1024x24",
                   "-nolisten", "tcp", "-noreset", static_cast<char*>(nullptr));
            _exit(127);
        }
        close(ends[1]);
        std::string number; // which the server tells, with a line's end, once it is ready
        for (char digit; ::read(ends[0], &digit, 1) == 1 && digit != '\n';)
            number += digit;
        close(ends[0]);
        if (number.empty()) {
            waitpid(server_, nullptr, 0);
            throw std::runtime_error("Xvfb does not start");
        }
        setenv("DISPLAY", (":" + number).c_str(), 1);
    }
    VirtualDisplay(const VirtualDisplay&) = delete;
    VirtualDisplay& operator=(const VirtualDisplay&) = delete;
    ~VirtualDisplay() {
        unsetenv("DISPLAY");
        kill(server_, SIGTERM);
        waitpid(server_, nullptr, 0);
    }

  private:
    pid_t server_ = -1;
};

} // namespace rapport::tests
