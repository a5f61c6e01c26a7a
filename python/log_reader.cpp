#include "common/bus/log_reader.hpp"

#include <fmt/format.h>

#include <map>

#include "common/bus/field_kinds.hpp"
#include "idl/fields.hpp"
#include "idl/topics.hpp"
#include "python/bindings.hpp"

namespace palpate::python {
namespace {

template <class T>
py::object value_of(const T& value);

/// A struct in a message.
template <class T>
py::dict dict_of(const T& value) {
  py::dict dict;
  fields([&](const char* name, const auto& field) { dict[name] = value_of(field); }, value);
  return dict;
}

template <class T>
py::object value_of(const T& value) {
  if constexpr (std::is_arithmetic_v<T> || std::same_as<T, std::string>) {
    return py::cast(value);
  } else if constexpr (is_vector<T> || is_array<T>) {
    using Element = typename T::value_type;
    if constexpr (std::is_arithmetic_v<Element>) {
      return py::array_t<Element>(static_cast<py::ssize_t>(value.size()), value.data());
    } else {
      py::list list;
      for (const Element& element : value) list.append(value_of(element));
      return list;
    }
  } else {
    return dict_of(value);
  }
}

/// One field of all messages: an array where it has the same shape in each, else a list.
template <class T>
class Column {
 public:
  void add(const T& value) {
    if constexpr (std::is_arithmetic_v<T>)
      numbers_.push_back(value);
    else if constexpr (is_array<T>)
      numbers_.insert(numbers_.end(), value.begin(), value.end());
    else
      list_.append(value_of(value));
  }
  py::object take(std::size_t rows) const {
    if constexpr (std::is_arithmetic_v<T> || is_array<T>) {
      py::ssize_t columns = 0;
      if constexpr (is_array<T>) columns = std::tuple_size_v<T>;
      auto array = new_array<Number>(static_cast<py::ssize_t>(rows), columns);
      std::copy(numbers_.begin(), numbers_.end(), array.mutable_data());
      return array;
    } else {
      return list_;
    }
  }

 private:
  static auto number() {
    if constexpr (is_array<T>)
      return typename T::value_type{};
    else if constexpr (std::is_arithmetic_v<T>)
      return T{};
    else
      return 0;
  }
  using Number = decltype(number());
  std::vector<Number> numbers_;
  py::list list_;
};

/// A UserWarning where not all of the log could be read.
void warn_of_damage(const LogReader& reader) {
  const std::string damage = reader.damage_text();
  if (!damage.empty() && PyErr_WarnEx(PyExc_UserWarning, damage.c_str(), 1) != 0) throw py::error_already_set();
}

template <class M>
py::dict columns_of(const std::filesystem::path& file, const Topic<M>& topic) {
  LogReader reader(file);
  std::vector<std::int64_t> receive_ns;
  std::vector<M> messages;
  M message;
  for (LogEvent event; reader.next(event);) {
    if (!event.read(topic, message)) continue;
    receive_ns.push_back(event.receive_ns);
    messages.push_back(message);
  }
  warn_of_damage(reader);
  py::dict columns;
  columns["receive_ns"] = py::array_t<std::int64_t>(static_cast<py::ssize_t>(receive_ns.size()), receive_ns.data());
  M shape;
  std::size_t index = 0;
  fields(
      [&]<class T>(const char* name, const T&) {
        Column<T> column;
        for (const M& of : messages) {
          std::size_t at = 0;
          fields(
              [&]<class Field>(const char*, const Field& field) {
                if constexpr (std::same_as<Field, T>)
                  if (at == index) column.add(field);
                ++at;
              },
              of);
        }
        columns[name] = column.take(messages.size());
        ++index;
      },
      shape);
  return columns;
}

py::dict read_log(const std::filesystem::path& file, const std::string& topic) {
  const std::string name = topic.find('/') == topic.npos ? "palpate/" + topic : topic;
  py::object found = py::none();
  std::string known;
  topics::for_each([&](const auto& each) {
    known += fmt::format(" {}", std::string(each.name).substr(8));
    if (name == each.name) found = columns_of(file, each);
  });
  if (found.is_none()) throw py::value_error(fmt::format("there is no topic '{}'; the topics are{}", topic, known));
  return found;
}

std::map<std::string, std::size_t> topics_in(const std::filesystem::path& file) {
  std::map<std::string, std::size_t> counts;
  LogReader reader(file);
  for (LogEvent event; reader.next(event);) ++counts[event.channel];
  warn_of_damage(reader);
  return counts;
}

}  // namespace

void bind_log(py::module_& module) {
  module.def(
      "read_log", &read_log, py::arg("file"), py::arg("topic"),
      "Every sample of a topic, a column for each field: arrays (n,) or (n, k), lists for texts and sequences; "
      "receive_ns\n"
      "is when the recorder got it. Units are in docs/topics.md. Warns with the sentence of `palpate info` where "
      "the log is\n"
      "damaged or cut off.");
  module.def("topics_in", &topics_in, py::arg("file"),
             "How many samples a log has of each topic; warns as read_log does.");
}

}  // namespace palpate::python
