#include "renderer/app/program.h"

#include "renderer/app/commands.h"
#include "renderer/core/error.h"
#include "renderer/core/parallel.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <exception>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <functional>
#include <new>
#include <unistd.h>
#include <vector>

namespace rapport {

bool shows_progress(const CommonOptions& common) {
    return !common.quiet && isatty(STDERR_FILENO) != 0;
}

namespace {

CLI::Validator number(const std::string& expected, const std::function<bool(double)>& fits) {
    return {[=](const std::string& text) {
                double value = 0;
                return CLI::detail::lexical_cast(text, value) && std::isfinite(value) && fits(value)
                           ? std::string()
                           : fmt::format("expected {}, found {}", expected, text);
            },
            expected};
}

} // namespace

CLI::Validator finite_number(double least, double most) {
    return number(fmt::format("a number from {} to {}", least, most),
                  [=](double value) { return value >= least && value <= most; });
}
CLI::Validator positive_number() {
    return number("a number above 0", [](double value) { return value > 0; });
}
CLI::Validator non_negative_number() {
    return number("a number of 0 or more", [](double value) { return value >= 0; });
}
CLI::Validator whole_number(uint64_t least) {
    const std::string expected = fmt::format("a whole number of {} or more", least);
    return {[=](const std::string& text) {
                uint64_t value = 0;
                const char* const end = text.data() + text.size();
                const auto [next, error] = std::from_chars(text.data(), end, value);
                return error == std::errc() && next == end && value >= least
                           ? std::string()
                           : fmt::format("expected {}, found {}", expected, text);
            },
            expected};
}

namespace {

/// One line on standard error, whatever the message held.
int complain(std::string message) {
    std::ranges::replace(message, '\n', ' ');
    fmt::print(stderr, "rapport: {}\n", message);
    return 2;
}

/// What to say where the command line names no subcommand.
std::string missing_command(const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
        names.push_back(command->get_name());
    const std::vector<std::string> rest = app.remaining();
    return fmt::format("command line: expected one of {}, found {}", fmt::join(names, ", "),
                       rest.empty() ? "none" : rest.front());
}

} // namespace

int run_program(int argc, char** argv) {
    CLI::App app{"From a weave draft to the light on a garment.", "rapport"};
    app.set_version_flag("--version", "rapport " RAPPORT_VERSION);
    app.require_subcommand(1);
    app.fallthrough();

    CommonOptions common;
    int status = 0;
    app.add_option("--threads", common.threads, "Threads to use (default: all)")
        ->check(CLI::Range(1, 1024));
    app.add_option("--seed", common.seed, "Seed of all random numbers (default 0)")
        ->check(whole_number(0));
    app.add_flag("--quiet", common.quiet, "Only results and errors");
    app.parse_complete_callback([&common] { set_thread_count(common.threads); });

    add_vgsp_command(app, common);
    add_render_command(app, common);
    add_view_command(app, common);
    add_diff_command(app, status);
    add_info_command(app);
    add_export_command(app, common);

    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& request) { // --help, --version
        return app.exit(request);
    } catch (const CLI::ParseError& error) {
        if (dynamic_cast<const CLI::RequiredError*>(&error) && app.get_subcommands().empty())
            return complain(missing_command(app));
        return complain(fmt::format("command line: {}", error.what()));
    } catch (const std::bad_alloc&) {
        return complain("out of memory");
    } catch (const std::exception& error) {
        return complain(error.what());
    }
    return status;
}

} // namespace rapport
