// A validator for the part of JSON Schema draft 7 that Assets/scene.schema.json uses; an unknown keyword is an error.
#pragma once
#include <algorithm>
#include <set>
#include <stdexcept>
#include <string>

#include <nlohmann/json.hpp>

namespace rt::test {

class JsonSchema {
  public:
    explicit JsonSchema(nlohmann::json schema) : root_(std::move(schema)) {}

    bool accepts(const nlohmann::json& value) const { return accepts(root_, value); }

  private:
    using Json = nlohmann::json;

    static bool hasType(const Json& value, const std::string& type) {
        if (type == "object") return value.is_object();
        if (type == "array") return value.is_array();
        if (type == "string") return value.is_string();
        if (type == "boolean") return value.is_boolean();
        if (type == "integer") return value.is_number_integer();
        return value.is_number();
    }

    const Json& resolve(const std::string& reference) const {
        return root_.at(Json::json_pointer(reference.substr(1)));
    }

    long countAccepting(const Json& schemas, const Json& value) const {
        return std::count_if(schemas.begin(), schemas.end(), [&](const Json& s) { return accepts(s, value); });
    }

    bool accepts(const Json& schema, const Json& value) const {
        for (const auto& [key, rule] : schema.items())
            if (!obeys(key, rule, schema, value)) return false;
        return true;
    }

    bool obeys(const std::string& key, const Json& rule, const Json& schema, const Json& value) const {
        static const std::set<std::string> notes = {"$schema", "title", "description", "default", "definitions"};
        if (notes.count(key) > 0) return true;
        if (key == "$ref") return accepts(resolve(rule), value);
        if (key == "type") return hasType(value, rule);
        if (key == "const") return value == rule;
        if (key == "enum") return std::find(rule.begin(), rule.end(), value) != rule.end();
        if (key == "oneOf") return countAccepting(rule, value) == 1;
        if (key == "anyOf") return countAccepting(rule, value) > 0;
        if (key == "allOf") return countAccepting(rule, value) == static_cast<long>(rule.size());
        if (key == "minimum") return !value.is_number() || value >= rule;
        if (key == "maximum") return !value.is_number() || value <= rule;
        if (key == "exclusiveMinimum") return !value.is_number() || value > rule;
        if (key == "exclusiveMaximum") return !value.is_number() || value < rule;
        if (key == "minLength") return !value.is_string() || value.get_ref<const std::string&>().size() >= rule;
        if (key == "minItems") return !value.is_array() || value.size() >= rule;
        if (key == "maxItems") return !value.is_array() || value.size() <= rule;
        if (key == "items")
            return !value.is_array() ||
                   std::all_of(value.begin(), value.end(), [&](const Json& item) { return accepts(rule, item); });
        if (key == "required")
            return !value.is_object() || std::all_of(rule.begin(), rule.end(), [&](const Json& name) {
                return value.contains(name.get<std::string>());
            });
        if (key == "properties" || key == "additionalProperties") return membersObey(key, rule, schema, value);
        throw std::invalid_argument("keyword " + key);
    }

    bool membersObey(const std::string& key, const Json& rule, const Json& schema, const Json& value) const {
        if (!value.is_object()) return true;
        const Json listed = schema.value("properties", Json::object());
        for (const auto& [name, member] : value.items()) {
            if (key == "properties" && rule.contains(name) && !accepts(rule[name], member)) return false;
            if (key == "additionalProperties" && !listed.contains(name) &&
                (rule.is_boolean() ? !rule.get<bool>() : !accepts(rule, member)))
                return false;
        }
        return true;
    }

    Json root_;
};

} // namespace rt::test
