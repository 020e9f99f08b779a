// Where the inputs that fuzzing starts from are written, FOLDER/TARGET/*, and the words that mutations insert.
#pragma once
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <set>
#include <string>
#include <utility>

#include <nlohmann/json.hpp>

namespace rt::test {

namespace fs = std::filesystem;

class Seeds {
  public:
    explicit Seeds(fs::path folder) : folder_(std::move(folder)) {}

    fs::path place(const std::string& target, const std::string& name) const {
        fs::create_directories(folder_ / target);
        return folder_ / target / name;
    }
    void write(const std::string& target, const std::string& name, const std::string& bytes) const {
        std::ofstream(place(target, name), std::ios::binary) << bytes;
    }
    // Also the words that mutations of this target insert, those of the document: blind ones make few keys.
    void writeJson(const std::string& target, const std::string& name, const nlohmann::json& document) {
        write(target, name, document.dump());
        std::set<std::string>& words = words_[target];
        collect(document, words);
        // Numbers at the limits of types, and structures.
        for (const char* word : {"-1", "4294967295", "2147483648", "18446744073709551615", "1e300", "1e-300", "0.5",
                                 "null", "{}", "[]", "[0]", "true"})
            words.insert(word);
        writeWords(target, words);
    }
    void writeWords(const std::string& target, const std::set<std::string>& words) const {
        fs::create_directories(folder_ / "words");
        std::ofstream file(folder_ / "words" / target);
        for (const std::string& word : words) file << '"' << word << "\"\n";
    }

  private:
    static void collect(const nlohmann::json& value, std::set<std::string>& words) {
        const auto add = [&words](const std::string& text) {
            constexpr std::size_t kLongest = 40; // data are no words
            if (text.empty() || text.size() > kLongest || text.find_first_of("\"\\") != text.npos) return;
            words.insert("\\\"" + text + "\\\"");
        };
        if (value.is_string()) add(value.get<std::string>());
        if (value.is_object())
            for (const auto& [key, member] : value.items()) add(key);
        if (value.is_structured())
            for (const auto& member : value) collect(member, words);
    }

    std::map<std::string, std::set<std::string>> words_;
    fs::path folder_;
};

// The main function of a program that writes seeds into the folder that its only argument names.
template <class Write>
int writeSeeds(int argc, char** argv, const Write& write) {
    if (argc != 2) {
        std::cerr << "usage: " << argv[0] << " FOLDER\n";
        return 2;
    }
    Seeds seeds(argv[1]);
    write(seeds);
    return 0;
}

} // namespace rt::test
