#include "Common/Manual/Parse.h"

#include <algorithm>
#include <ostream>
#include <utility>

#include <CLI/CLI.hpp>

#include "Common/Core/Error.h"
#include "Common/Manual/Help.h"

namespace rt::manual {
namespace {

// CLI11 breaks some messages into lines.
std::string oneLine(std::string text) {
    std::replace(text.begin(), text.end(), '\n', ' ');
    return text;
}

// The page of the command that was given, if one was.
const Page& askedPage(const CLI::App& app, const Page& page) {
    const auto commands = app.get_subcommands();
    if (commands.empty()) return page;
    const std::string name = page.name + " " + commands.front()->get_name();
    const auto asked = std::find_if(page.commands.begin(), page.commands.end(),
                                    [&](const Page& command) { return command.name == name; });
    return asked == page.commands.end() ? page : *asked;
}

// CLI11 notes each option that it meets and, up to some version at least, keeps the notes of earlier command lines: who
// parses a million would keep a million's. `app` is no constant, nobody reads the notes.
void forgetParseOrder(CLI::App& app) {
    const_cast<std::vector<CLI::Option*>&>(app.parse_order()).clear();
}

} // namespace

bool parse(CLI::App& app, std::vector<std::string> arguments, std::ostream& out, const std::function<Page()>& page) {
    forgetParseOrder(app);
    std::reverse(arguments.begin(), arguments.end()); // the order in which CLI11 takes them
    try {
        app.parse(std::move(arguments));
        return true;
    } catch (const CLI::CallForHelp&) {
        const Page whole = page();
        out << helpText(askedPage(app, whole));
    } catch (const CLI::CallForAllHelp&) {
        out << fullHelpText(page());
    } catch (const CLI::CallForVersion& version) {
        out << version.what() << '\n';
    } catch (const CLI::FileError&) {
        throw;
    } catch (const CLI::ParseError& error) {
        throw UsageError(oneLine(error.what()));
    }
    return false;
}

} // namespace rt::manual
