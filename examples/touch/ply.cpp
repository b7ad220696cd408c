// SPDX-License-Identifier: MIT

#include "ply.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstring>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>

namespace touch {

namespace {

[[noreturn]] void refuse_ply(const std::string& why) { throw std::runtime_error(why); }

enum class Type { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

std::optional<Type> type_named(const std::string& name) {
  constexpr std::array<std::array<const char*, 2>, 8> names{{{"char", "int8"},
                                                             {"uchar", "uint8"},
                                                             {"short", "int16"},
                                                             {"ushort", "uint16"},
                                                             {"int", "int32"},
                                                             {"uint", "uint32"},
                                                             {"float", "float32"},
                                                             {"double", "float64"}}};
  for (std::size_t i = 0; i < names.size(); ++i)
    if (name == names[i][0] || name == names[i][1]) return static_cast<Type>(i);
  return {};
}

struct Property {
  std::string name;
  Type type;
  std::optional<Type> length;  // of a list
};
struct Element {
  std::string name;
  std::size_t count;
  std::vector<Property> properties;
};

class Reader {
 public:
  explicit Reader(std::string_view content) : content_(content) {}

  Polygons read() {
    read_header();
    const auto has = [&](const char* name) {
      return std::any_of(elements_.begin(), elements_.end(),
                         [&](const Element& e) { return e.name == name; });
    };
    if (!has("vertex") || !has("face")) refuse_ply("has no element vertex, or no element face");
    for (const Element& e : elements_)
      for (item_ = 0; item_ < e.count; ++item_) read_item(e);
    for (const std::uint32_t v : polygons_.corner)
      if (v >= polygons_.vertices.size())
        refuse_ply("a face names vertex " + std::to_string(v) + " of " +
                   std::to_string(polygons_.vertices.size()));
    return std::move(polygons_);
  }

 private:
  void read_header() {
    if (line() != "ply") refuse_ply("does not begin with the line \"ply\"");
    for (bool format = false;;) {
      if (at_ >= content_.size()) refuse_ply("has no end_header");
      std::istringstream words{std::string(line())};
      std::string word, name, type, length;
      words >> word;
      if (word.empty() || word == "comment" || word == "obj_info") continue;
      if (word == "end_header" && format) return;
      if (word == "format" && words >> name &&
          (name == "ascii" || name == "binary_little_endian" || name == "binary_big_endian")) {
        format = true;
        ascii_ = name == "ascii";
        swap_ = (name == "binary_big_endian") != (std::endian::native == std::endian::big);
      } else if (std::size_t count = 0; word == "element" && words >> name >> count) {
        // A byte for each at least, so that no header can ask for more than the file has.
        if (count > content_.size())
          refuse_ply("declares " + std::to_string(count) + " of element " + name + " in " +
                     std::to_string(content_.size()) + " bytes");
        elements_.push_back({name, count, {}});
      } else if (word == "property" && !elements_.empty() && words >> type) {
        const bool list = type == "list";
        if (list) words >> length >> type;
        const auto of = type_named(type), count_of = type_named(length);
        if (!(words >> name) || !of || list != count_of.has_value())
          refuse_ply("has a property that cannot be read: " + words.str());
        elements_.back().properties.push_back({name, *of, count_of});
      } else {
        refuse_ply("has a header line that cannot be read: " + words.str());
      }
    }
  }

  void read_item(const Element& e) {
    element_ = &e;
    const bool is_vertex = e.name == "vertex", is_face = e.name == "face";
    palpate::Vec3<double> position = palpate::Vec3<double>::Zero();
    int axes = 0, lists = 0;
    for (const Property& p : e.properties) {
      if (!p.length) {
        const double value = number(p.type);
        if (is_vertex && p.name.size() == 1 && p.name[0] >= 'x' && p.name[0] <= 'z')
          position[p.name[0] - 'x'] = value, ++axes;
        continue;
      }
      const std::uint32_t length = whole(number(*p.length));
      const bool corners = is_face && (p.name == "vertex_indices" || p.name == "vertex_index");
      for (std::uint32_t i = 0; i < length; ++i) {
        const double value = number(p.type);
        if (corners) polygons_.corner.push_back(whole(value));
      }
      lists += corners;
    }
    if (ascii_) end_line();
    if (is_vertex) {
      if (axes != 3) refuse_ply("has vertices without x, y and z");
      polygons_.vertices.push_back(position);
    }
    if (is_face) {
      if (lists != 1) refuse_ply("has faces without vertex_indices");
      polygons_.end.push_back(polygons_.corner.size());
    }
  }

  /// The next value of the item.
  double number(Type type) {
    if (ascii_) {
      while (at_ < content_.size() && (content_[at_] == ' ' || content_[at_] == '\t')) ++at_;
      double value = 0;
      const auto [end, error] =
          std::from_chars(content_.data() + at_, content_.data() + content_.size(), value);
      if (error != std::errc()) refuse_item("has a number that is missing or cannot be read");
      at_ = static_cast<std::size_t>(end - content_.data());
      return value;
    }
    switch (type) {
      case Type::int8:
        return binary<std::int8_t>();
      case Type::uint8:
        return binary<std::uint8_t>();
      case Type::int16:
        return binary<std::int16_t>();
      case Type::uint16:
        return binary<std::uint16_t>();
      case Type::int32:
        return binary<std::int32_t>();
      case Type::uint32:
        return binary<std::uint32_t>();
      case Type::float32:
        return static_cast<double>(binary<float>());
      case Type::float64:
        break;
    }
    return binary<double>();
  }
  template <class T>
  T binary() {
    std::array<char, sizeof(T)> bytes;
    if (content_.size() - at_ < sizeof(T)) refuse_item("is cut off");
    std::copy_n(content_.data() + at_, sizeof(T), bytes.begin());
    if (swap_) std::reverse(bytes.begin(), bytes.end());
    at_ += sizeof(T);
    return std::bit_cast<T>(bytes);
  }
  std::uint32_t whole(double value) const {
    if (!(value >= 0 && value <= 0xffffffff) ||
        value != static_cast<double>(static_cast<std::uint32_t>(value)))
      refuse_item("has an index or a length that is no whole number >= 0");
    return static_cast<std::uint32_t>(value);
  }

  /// Up to the end of the line, which is passed over: \n, \r or \r\n.
  std::string_view line() {
    const std::size_t begin = at_, end = (std::min)(content_.find_first_of("\r\n", begin), content_.size());
    at_ = (std::min)(end + 1, content_.size());
    if (end + 1 < content_.size() && content_[end] == '\r' && content_[end + 1] == '\n') ++at_;
    return content_.substr(begin, end - begin);
  }
  void end_line() {
    if (line().find_first_not_of(" \t") != std::string_view::npos)
      refuse_item("has more on its line than the header says");
  }
  [[noreturn]] void refuse_item(const char* why) const {
    refuse_ply(element_->name + " " + std::to_string(item_) + " of " + std::to_string(element_->count) + " " +
               why);
  }

  std::string_view content_;
  std::size_t at_ = 0;
  bool ascii_ = true, swap_ = false;
  std::vector<Element> elements_;
  Polygons polygons_;
  const Element* element_ = nullptr;  // that is read, for messages
  std::size_t item_ = 0;
};

}  // namespace

Polygons parse_ply(std::string_view content) { return Reader(content).read(); }

}  // namespace touch
