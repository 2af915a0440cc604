#pragma once

#include <map>
#include <string>
#include <vector>

namespace rapport {

/// Names to factories, filled by static `Registered` objects beside the things they make, so that
/// a new material or light is one new file. `Factory` is any copyable callable type; each factory
/// type has one registry.
template <class Factory> class Registry {
  public:
    static Registry& instance() {
        static Registry registry;
        return registry;
    }
    void add(const std::string& name, Factory factory) { factories_[name] = std::move(factory); }
    /// The factory of that name, or nullptr.
    const Factory* find(const std::string& name) const {
        const auto found = factories_.find(name);
        return found == factories_.end() ? nullptr : &found->second;
    }
    /// All names, sorted.
    std::vector<std::string> names() const {
        std::vector<std::string> names;
        for (const auto& [name, factory] : factories_)
            names.push_back(name);
        return names;
    }

  private:
    std::map<std::string, Factory> factories_;
};

template <class Factory> struct Registered {
    Registered(const std::string& name, Factory factory) {
        Registry<Factory>::instance().add(name, std::move(factory));
    }
};

} // namespace rapport
