#include "calot/viewer/language.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "calot/base/error.h"
#include "calot/scene/scene.h"
#include "calot/training/metrics.h"
#include "calot/training/questionnaire.h"
#include "calot/training/task.h"
#include "calot/viewer/data_files.h"
#include "calot/viewer/exercise.h"
#include "support/paths.h"

namespace calot::viewer {
namespace {

const std::string kLanguages = CALOT_SOURCE_DIR "/data/lang";

/// Texts that have no key: those of tasks, measures and the questionnaire, a line each.
std::string other_texts() {
    std::string texts = "\n";
    const auto add = [&](const std::string& text) { texts += text + "\n"; };
    for (const training::Metric& metric : training::metric_table()) add(metric.title);
    for (const training::Question& question : training::questions()) add(question.text);
    for (const char* word : training::scale()) add(word);
    for (const std::string& path : training::list_tasks({CALOT_SOURCE_DIR "/scenes/tasks"})) {
        const training::Task task = training::load_task(path);
        add(task.title);
        add(task.goal);
        for (const std::string& hint : task.hints) add(hint);
        for (const training::Patient& patient : task.patients) add(patient.name);
        for (const training::Limit& limit : task.limits) add(limit.message);
    }
    return texts;
}

TEST(Language, every_translation_has_every_text_and_no_other) {
    const Language english(kLanguages, "en");
    for (const std::string& name : Language::available(kLanguages)) {
        std::ifstream file(kLanguages + "/" + name + ".toml");
        const std::string text((std::istreambuf_iterator<char>(file)), {});
        const Language language(kLanguages, name);
        // Beyond that, texts of tasks, measures and questions: those that there are.
        const std::string others = other_texts();
        for (const auto& [key, value] : language.texts())
            if (english.texts().count(key) == 0) {
                EXPECT_NE(others.find("\n" + key + "\n"), std::string::npos) << name << " has no use for " << key;
            }
        for (const auto& [key, value] : english.texts()) {
            if (key.rfind("language.", 0) == 0) continue;  // names of languages stay as they are
            EXPECT_NE(text.find("\"" + key + "\" = "), std::string::npos) << name << " lacks " << key;
        }
    }
}

TEST(Language, what_is_no_key_is_itself_the_text) {
    const Language english(kLanguages, "en");
    EXPECT_EQ(english("pause.title"), "Paused");
    EXPECT_EQ(english("A drill of somebody's own"), "A drill of somebody's own");
    EXPECT_EQ(Language(kLanguages, "de")("language.en"), "English");  // from English
}

TEST(Language, bad_files_are_told_with_their_line) {
    const auto folder = std::filesystem::temp_directory_path() / ("calot_language." + std::to_string(::getpid()));
    std::filesystem::create_directories(folder);
    std::ofstream(folder / "en.toml") << "\"a\" = \"A\"\n";
    std::ofstream(folder / "xx.toml") << "\n\"a\" = 7\n";
    std::ofstream(folder / "yy.toml") << "\"a\" = \"A\n";
    for (const auto& [name, line] : {std::pair{"xx", 2}, std::pair{"yy", 1}}) {
        try {
            Language(folder.string(), name);
            ADD_FAILURE() << name;
        } catch (const InputError& error) {
            EXPECT_EQ(error.line, line) << error.describe();
            EXPECT_NE(error.file.find(name), std::string::npos);
            EXPECT_FALSE(error.hint.empty());
        }
    }
    std::filesystem::remove_all(folder);
}

TEST(DataFiles, found_from_the_source_tree_and_where_told) {
    EXPECT_EQ(std::filesystem::canonical(data_directory()), std::filesystem::canonical(CALOT_SOURCE_DIR "/data"));
    EXPECT_TRUE(std::filesystem::exists(scene_file("calot.toml")));
    EXPECT_THROW(scene_file("no-such-scene.toml"), InputError);
}

TEST(Patients, every_one_is_a_valid_scene) {
    for (const Patient& patient : patients()) {
        scene::Scene scene = scene::load(scene_file("calot.toml"));
        for (const std::string& assignment : patient.assignments) scene::override_value(scene, assignment);
        scene.seed = patient.seed;
        EXPECT_NO_THROW(scene::check(scene));
        EXPECT_NO_THROW(scene::build_anatomy(scene)) << patient.about;
    }
}

}  // namespace
}  // namespace calot::viewer
