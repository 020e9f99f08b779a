#include "Common/Manual/ManPage.h"

#include <algorithm>
#include <cctype>

namespace rt::manual {
namespace {

// Text that roff takes for text.
std::string escaped(const std::string& text) {
    std::string out;
    if (text.starts_with('.') || text.starts_with('\'')) out = "\\&";
    for (const char c : text) {
        if (c == '\\')
            out += "\\e";
        else if (c == '-')
            out += "\\-";
        else
            out += c;
    }
    return out;
}

std::string bold(const std::string& text) {
    return "\\fB" + escaped(text) + "\\fR";
}

std::string upperCase(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::toupper(c); });
    return text;
}

// An argument of a macro.
std::string quoted(const std::string& text) {
    return "\"" + text + "\"";
}

void appendTerm(std::string& out, const std::string& term, const std::string& text) {
    out += ".TP\n" + term + "\n" + escaped(text) + "\n";
}

void appendTerms(std::string& out, const char* title, const std::vector<Term>& terms) {
    if (terms.empty()) return;
    out += std::string(".SH ") + quoted(title) + "\n";
    for (const Term& term : terms) appendTerm(out, bold(term.name), term.help);
}

void appendFlag(std::string& out, const Flag& flag) {
    std::string term;
    for (const std::string& name : flag.names) term += (term.empty() ? "" : ", ") + bold(name);
    if (!flag.value.empty()) term += " \\fI" + escaped(shownValue(flag)) + "\\fR";
    std::string text = flag.help.empty() ? "An argument." : flag.help;
    if (!flag.byDefault.empty()) text += " (default: " + flag.byDefault + ")";
    appendTerm(out, term, text);
    if (flag.choices.empty()) return;
    out += ".RS\n";
    for (const Term& choice : flag.choices) appendTerm(out, bold(choice.name), choice.help);
    out += ".RE\n";
}

// Arguments and flags of a program or of a command.
void appendFlags(std::string& out, const Page& page) {
    for (const Flag& argument : page.arguments) appendFlag(out, argument);
    const std::vector<std::string> groups = groupsOf(page);
    for (const std::string& group : groups) {
        if (groups.size() > 1) out += ".SS " + quoted(escaped(group)) + "\n";
        for (const Flag& flag : page.flags)
            if (flag.group == group) appendFlag(out, flag);
    }
}

void appendExamples(std::string& out, const std::vector<Term>& examples) {
    if (examples.empty()) return;
    out += ".SH EXAMPLES\n";
    for (const Term& example : examples) appendTerm(out, bold(example.name), example.help);
}

} // namespace

std::string manPage(const Page& page, const std::string& version) {
    std::string out = ".TH " + quoted(escaped(upperCase(page.name))) + " 1 \"\" " +
                      quoted("Ray Tracing Twins " + version) + " \"User Commands\"\n";
    const std::string firstSentence = page.summary.substr(0, page.summary.find(". "));
    out += ".SH NAME\n" + escaped(page.name) + " \\- " + escaped(firstSentence) + "\n";
    out += ".SH SYNOPSIS\n" + bold(page.name) + escaped(usageOf(page).substr(page.name.size())) + "\n";
    out += ".SH DESCRIPTION\n" + escaped(page.summary) + "\n.SH OPTIONS\n";
    appendFlags(out, page);
    for (const Page& command : page.commands) {
        out += ".SH " + quoted(escaped(upperCase(command.name.substr(page.name.size() + 1)))) + "\n";
        out += bold(command.name) + escaped(usageOf(command).substr(command.name.size())) + "\n.PP\n" +
               escaped(command.summary) + ".\n";
        appendFlags(out, command);
    }
    appendTerms(out, "EXIT STATUS", exitCodes());
    appendTerms(out, "ENVIRONMENT", page.environment);
    appendExamples(out, page.examples);
    out += ".SH SEE ALSO\n";
    std::string others;
    for (const char* name : {"ray-tracing-bench", "ray-tracing-cpu", "ray-tracing-gpu", "ray-tracing-image"})
        if (page.name != name) others += (others.empty() ? "" : ", ") + bold(name) + "(1)";
    return out + others + "\n";
}

} // namespace rt::manual
