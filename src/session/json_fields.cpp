#include "session/json_fields.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "base/hash.h"
#include "base/suggest.h"

namespace calot {
namespace {

const Json nothing;

constexpr std::size_t longest_shown = 60;   // bytes
constexpr std::size_t longest_text = 4096;  // bytes: a path's

/// A value as it is written, its beginning where it is long. What holds others is named only: it may be nested deeper
/// than a stack reaches.
std::string shown(const Json& value) {
  if (value.is_array()) return "a list";
  if (value.is_object()) return "an object";
  return shortened(value.dump(), longest_shown);
}

bool all_texts(const Json& list) {
  return std::all_of(list.begin(), list.end(), [](const Json& item) { return item.is_string(); });
}

}  // namespace

Json parse_json(std::string_view text, std::string& problem) {
  try {
    return Json::parse(text);
  } catch (const Json::parse_error& error) {
    problem = error.byte > text.size() ? "this ends in the middle"
                                       : fmt::format("this is not JSON at byte {}", error.byte);
  } catch (const Json::exception&) {  // a number like 1e999
    problem = "this holds a number beyond what a double can be";
  }
  return {};
}

bool is_utf8(const std::string& text) {
  // The library drops what is not UTF-8 when it is told to.
  return Json::parse(Json(text).dump(-1, ' ', false, Json::error_handler_t::ignore)) == Json(text);
}

const Json* JsonFields::take(const std::string& key) {
  taken_.insert(key);
  if (has(key)) return &json_.at(key);
  problems_.push_back(fmt::format("{}{} is missing", prefix_, key));
  return nullptr;
}

void JsonFields::wrong(const std::string& key, const std::string& why) {
  problems_.push_back(fmt::format("{}{} {}", prefix_, shortened(key, longest_shown), why));
}

std::string JsonFields::text(const std::string& key) {
  const Json* value = take(key);
  if (value == nullptr) return {};
  if (!value->is_string())
    wrong(key, fmt::format("must be a text, not {}", shown(*value)));
  else if (const auto& text = value->get_ref<const std::string&>(); text.size() <= longest_text)
    return text;
  else
    wrong(key, fmt::format("has {} bytes, more than {}", text.size(), longest_text));
  return {};
}

double JsonFields::number(const std::string& key, double least, double most) {
  const Json* value = take(key);
  if (value == nullptr) return 0;
  if (value->is_number() && value->get<double>() >= least && value->get<double>() <= most)
    return value->get<double>();
  wrong(key, value->is_number() ? fmt::format("is {}, not within {:g} and {:g}", shown(*value), least, most)
                                : fmt::format("must be a number, not {}", shown(*value)));
  return 0;
}

int JsonFields::integer(const std::string& key, int least, int most) {
  const Json* value = take(key);
  if (value == nullptr) return 0;
  if (value->is_number_integer() && value->get<double>() >= least && value->get<double>() <= most)
    return value->get<int>();
  wrong(key, fmt::format("must be a whole number from {} to {}, not {}", least, most, shown(*value)));
  return 0;
}

std::uint64_t JsonFields::count(const std::string& key) {
  const Json* value = take(key);
  if (value == nullptr) return 0;
  if (value->is_number_unsigned()) return value->get<std::uint64_t>();
  wrong(key, fmt::format("must be a whole number that is not negative, not {}", shown(*value)));
  return 0;
}

std::uint64_t JsonFields::hash(const std::string& key) {
  const Json* member = take(key);
  if (member == nullptr) return 0;
  const std::string digits = member->is_string() ? member->get<std::string>() : std::string();
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value, 16);
  if (error == std::errc() && end == digits.data() + digits.size() && hex(value) == digits) return value;
  wrong(key, fmt::format("must be sixteen lower-case hexadecimal digits, not {}", shown(*member)));
  return 0;
}

std::vector<std::string> JsonFields::texts(const std::string& key) {
  const Json* value = take(key);
  if (value == nullptr) return {};
  if (value->is_array() && all_texts(*value)) return value->get<std::vector<std::string>>();
  wrong(key, "must be a list of texts");
  return {};
}

std::map<std::string, std::string> JsonFields::text_map(const std::string& key) {
  const Json* value = take(key);
  if (value == nullptr) return {};
  if (value->is_object() && all_texts(*value)) return value->get<std::map<std::string, std::string>>();
  wrong(key, "must be an object of texts");
  return {};
}

const Json& JsonFields::any(const std::string& key) {
  const Json* value = take(key);
  return value != nullptr ? *value : nothing;
}

void JsonFields::expect_no_others() {
  if (!json_.is_object()) return;
  for (const auto& [key, value] : json_.items())
    if (!taken_.contains(key))
      wrong(key, "is not known here; " + suggestion(key, {taken_.begin(), taken_.end()}));
}

}  // namespace calot
