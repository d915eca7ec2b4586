// The pitviper program: finds the command, turns errors into one line and an exit code.
#include <algorithm>
#include <cstdio>
#include <exception>
#include <new>

#include "scenarios/commands/commands.hpp"
#include "scenarios/commands/process.hpp"
#include "scenarios/sweep/sweep_command.hpp"
#include "scenarios/sweep/sweep_file.hpp"
#include "scenarios/view/view_command.hpp"
#include "sim/frame/version.hpp"

namespace {

using namespace pitviper;

/// As `pitviper --help` lists them; those of one first word together, the plain one before the others.
std::vector<CommandLine> commands() {
  return {runCommand(),           sweepCommand(),
          viewCommand(),          checkCommand(),
          planCommand(),          auditCommand(),
          infoCommand(),          integrateCommand(),
          streamCommand(),        selfTestCommand(),
          measureCommand(),       benchCommand(),
          scenarioBenchCommand(), accuracyBenchCommand(),
          firstBenchCommand(),    onceBenchCommand(),
          guardBenchCommand(),    phongBenchCommand(),
          materialCommand(),      atmosphereCommand(),
          skyCommand(),           keysCommand(sweepKeyReference())};
}

void printHelp() {
  std::printf("pitviper: infrared and optronic sensor scenes in calibrated units\n\nusage: pitviper COMMAND ...\n\n");
  const auto row = [](const std::string& name, const std::string& summary) { std::printf("  %-10s %s\n", name.c_str(), summary.c_str()); };
  for (const CommandLine& c : commands())
    if (c.name.find(' ') == c.name.npos) row(c.name, c.summary);
  row("test", "build and run every test (the pitviper script)");
  row("python", "Python with `import pitviper` (the pitviper script)");
  row("figures", "write the figures in the documents anew (the pitviper script)");
  std::printf(
      "\npitviper COMMAND --help tells more. Exit codes: 0 done, 1 the machine could not, 2 a mistake in the input, 3 frames of a stream unaccounted for, 4 an "
      "audit found more than was asked, 130 and 143 ended by a signal.\n");
}

bool isHelp(const std::string& word) { return word == "--help" || word == "-h"; }

int run(Arguments arguments) {
  if (arguments.empty() || isHelp(arguments[0]) || (arguments[0] == "help" && arguments.size() == 1)) {
    printHelp();
    return arguments.empty() ? 2 : 0;
  }
  if (arguments[0] == "--version") {
    std::printf("pitviper %s\n", kVersion);
    return 0;
  }
  if (arguments[0] == "help") arguments = {arguments[1], "--help"};
  const std::string name = arguments[0];
  arguments.erase(arguments.begin());
  std::vector<CommandLine> own;
  std::vector<std::string> names;
  for (const CommandLine& c : commands()) {
    names.push_back(c.name.substr(0, c.name.find(' ')));
    if (names.back() == name) own.push_back(c);
  }
  if (own.empty())
    throw UserError({"pitviper", 0, 0, -1}, "unknown command '" + name + "'", "one of those of pitviper --help",
                    didYouMean(name, names, "see pitviper --help"));
  if (std::any_of(arguments.begin(), arguments.end(), isHelp)) {
    std::fputs(helpOf(own).c_str(), stdout);
    return 0;
  }
  for (const CommandLine& c : own)
    if (c.name != name)
      if (const auto at = std::find(arguments.begin(), arguments.end(), c.name.substr(name.size() + 1)); at != arguments.end()) {
        arguments.erase(at);
        return perform(c, arguments, own);
      }
  return perform(own[0], arguments, own);
}

}  // namespace

int main(int argc, char** argv) {
  prepareProcess();
  int code = 0;
  try {
    code = run({argv + 1, argv + argc});
  } catch (const UserError& e) {
    std::fflush(stdout);
    tell(e.what());
    code = 2;
  } catch (const std::bad_alloc&) {
    std::fflush(stdout);
    code = tellOutOfMemory();
  } catch (const std::exception& e) {
    std::fflush(stdout);
    tell((std::string("pitviper: ") + e.what()).c_str());
    code = 1;
  }
  return finishOutput(code);
}
