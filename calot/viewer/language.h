#pragma once
// The texts on screen, from a language file: key = "text". English is what a key missing elsewhere falls back to.

#include <map>
#include <string>
#include <vector>

namespace calot::viewer {

class Language {
  public:
    Language() = default;
    /// Reads `directory`/`name`.toml over `directory`/en.toml. Throws InputError with file and line when one cannot be
    /// read or holds anything but texts.
    Language(const std::string& directory, const std::string& name);

    /// The text of a key; what is no key is itself the text.
    const std::string& operator()(const std::string& key) const;
    const std::string& name() const { return name_; }
    const std::map<std::string, std::string>& texts() const { return texts_; }

    /// Names of the language files in a directory ("de", "en"), sorted.
    static std::vector<std::string> available(const std::string& directory);

  private:
    void read(const std::string& path);

    std::string name_;
    std::map<std::string, std::string> texts_;
};

}  // namespace calot::viewer
