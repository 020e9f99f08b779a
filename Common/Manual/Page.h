// What a program can be told, for readers. It is taken from the very parser that reads the command line; --help, man
// pages, completions and docs/reference.md are made from it.
#pragma once
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace rt::manual {

struct Term {
    std::string name, help;
};

struct Flag {
    std::vector<std::string> names; // "--output", "-o": long ones first; of an argument without a flag, its name
    std::string value;              // what it takes, in a form of Values.h; empty: a switch
    std::string help;               // one paragraph
    std::vector<Term> choices;      // values that need a word
    std::string byDefault;
    std::string group;
    bool isRepeatable = false;
    bool mayOmitValue = false;
    bool isRequired = false; // of arguments
};

// Of a program, or of a command of one.
struct Page {
    std::string name; // "ray-tracing-cpu", "ray-tracing-image diff"
    std::string summary;
    std::vector<Flag> arguments, flags;
    std::vector<Page> commands;

    std::vector<std::string> essentials; // flags that --help shows, in this order; empty: all
    std::vector<Term> examples;          // command lines, and what they do
    std::vector<Term> environment;
};

// Hidden flags are left out. The writer of the parser adds what parsers do not know: essentials and what follows.
Page pageOf(const CLI::App& app);

// The flag with this spelling; null where there is none.
const Flag* findFlag(const Page& page, const std::string& name);

// The groups in the order in which flags first name them.
std::vector<std::string> groupsOf(const Page& page);

// "ray-tracing-image diff [FLAGS] A B".
std::string usageOf(const Page& page);

// "--output, -o F" or "--denoise [only]", as the parts before and behind the space.
std::string spellingsOf(const Flag& flag);
std::string shownValue(const Flag& flag);

// What every program ends with.
const std::vector<Term>& exitCodes();

} // namespace rt::manual
