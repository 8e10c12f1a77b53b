#pragma once
// Builds the table of keys: one line a key. `field` is a function that returns the stored variable.

#include <utility>

#include "calot/scene/keys.h"

namespace calot::scene {

inline constexpr Unit kNoUnit{"", 1.0, 0.0};
inline constexpr Unit kMm{"mm", 1e-3, 0.0};
inline constexpr Unit kSecond{"s", 1.0, 0.0};
inline constexpr Unit kDegree{"degrees", 0.017453292519943295, 0.0};
inline constexpr Unit kCelsius{"degrees Celsius", 1.0, 273.15};
inline constexpr Unit kKilopascal{"kPa", 1e3, 0.0};
inline constexpr Unit kFlow{"ml/(min kg)", 1e-6 / 60.0, 0.0};
inline constexpr Unit named(const char* name) {
    return {name, 1.0, 0.0};
}

/// Field functions take `R&` and return a reference. Reading goes through the same function; it changes nothing.
template <class R>
class KeyTable {
  public:
    explicit KeyTable(Group& group) : group_(group) {}

    template <class F>
    Key& number(const char* name, const Unit& unit, double low, double high, F field, const char* documentation) {
        Key& key = add(name, KeyType::number, documentation);
        key.unit = unit;
        key.low = low;
        key.high = high;
        key.get = [=](const void* r) { return Value(file_value(field(record(r)), unit)); };
        key.set = [=](void* r, const Value& v) { field(record(r)) = unit.to_si(std::get<double>(v)); };
        return key;
    }
    template <class F>
    Key& integer(const char* name, const Unit& unit, double low, double high, F field, const char* documentation) {
        using T = std::remove_reference_t<decltype(field(std::declval<R&>()))>;
        Key& key = add(name, KeyType::integer, documentation);
        key.unit = unit;
        key.low = low;
        key.high = high;
        key.get = [=](const void* r) { return Value(static_cast<std::int64_t>(field(record(r)))); };
        key.set = [=](void* r, const Value& v) { field(record(r)) = static_cast<T>(std::get<std::int64_t>(v)); };
        return key;
    }
    template <class F>
    Key& boolean(const char* name, F field, const char* documentation) {
        Key& key = add(name, KeyType::boolean, documentation);
        key.get = [=](const void* r) { return Value(bool{field(record(r))}); };
        key.set = [=](void* r, const Value& v) { field(record(r)) = std::get<bool>(v); };
        return key;
    }
    template <class F>
    Key& text(const char* name, F field, const char* documentation) {
        Key& key = add(name, KeyType::text, documentation);
        key.get = [=](const void* r) { return Value(std::string(field(record(r)))); };
        key.set = [=](void* r, const Value& v) { field(record(r)) = std::get<std::string>(v); };
        return key;
    }
    template <class F>
    Key& vector(const char* name, const Unit& unit, double low, double high, F field, const char* documentation) {
        Key& key = add(name, KeyType::vector, documentation);
        key.unit = unit;
        key.low = low;
        key.high = high;
        key.get = [=](const void* r) {
            const Vec3& si = field(record(r));
            return Value(Vec3(file_value(si.x, unit), file_value(si.y, unit), file_value(si.z, unit)));
        };
        key.set = [=](void* r, const Value& v) {
            const Vec3& file = std::get<Vec3>(v);
            field(record(r)) = Vec3(unit.to_si(file.x), unit.to_si(file.y), unit.to_si(file.z));
        };
        return key;
    }
    /// An enumeration stored as its number, named by `choices` in that order.
    template <class F>
    Key& choice(const char* name, std::vector<std::string> choices, F field, const char* documentation) {
        using T = std::remove_reference_t<decltype(field(std::declval<R&>()))>;
        Key& key = add(name, KeyType::choice, documentation);
        key.choices = choices;
        key.get = [=](const void* r) { return Value(choices[static_cast<std::size_t>(field(record(r)))]); };
        key.set = [=](void* r, const Value& v) {
            for (std::size_t k = 0; k < choices.size(); ++k)
                if (choices[k] == std::get<std::string>(v)) field(record(r)) = static_cast<T>(k);
        };
        return key;
    }
    /// One of several words, stored as such.
    template <class F>
    Key& word(const char* name, std::vector<std::string> choices, F field, const char* documentation) {
        Key& key = text(name, field, documentation);
        key.type = KeyType::choice;
        key.choices = std::move(choices);
        return key;
    }
    /// A number that is drawn from the patient's seed unless the scene says it (stored in std::optional<double>).
    template <class F>
    Key& drawn(const char* name, const Unit& unit, double low, double high, F field, const char* documentation) {
        Key& key = add(name, KeyType::number, documentation);
        key.unit = unit;
        key.low = low;
        key.high = high;
        key.get = [=](const void* r) {
            const std::optional<double>& si = field(record(r));
            return si ? std::optional<Value>(file_value(*si, unit)) : std::nullopt;
        };
        key.set = [=](void* r, const Value& v) { field(record(r)) = unit.to_si(std::get<double>(v)); };
        return key;
    }
    template <class F>
    Key& drawn_boolean(const char* name, F field, const char* documentation) {
        Key& key = add(name, KeyType::boolean, documentation);
        key.get = [=](const void* r) {
            const std::optional<bool>& value = field(record(r));
            return value ? std::optional<Value>(*value) : std::nullopt;
        };
        key.set = [=](void* r, const Value& v) { field(record(r)) = std::get<bool>(v); };
        return key;
    }

  private:
    static R& record(const void* r) { return *static_cast<R*>(const_cast<void*>(r)); }
    Key& add(const char* name, KeyType type, const char* documentation) {
        Key& key = group_.keys.emplace_back();
        key.name = name;
        key.type = type;
        key.documentation = documentation;
        return key;
    }
    Group& group_;
};

}  // namespace calot::scene
