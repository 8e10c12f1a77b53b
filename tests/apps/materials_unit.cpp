// calot materials: complete, legible, and what docs/materials.md says.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "apps/program.h"
#include "calot/tissue/material.h"

namespace calot::test {

TEST(Materials, EveryValueHasUnitRangeAndSource) {
    const auto materials = tissue::default_materials();
    ASSERT_GT(materials.size(), 5u);
    for (std::size_t k = 1; k < materials.size(); ++k)
        for (const tissue::MaterialField& field : tissue::material_fields()) {
            EXPECT_TRUE(field.plausible(materials[k])) << materials[k].name << " " << field.key;
            const std::string source = tissue::material_source(materials[k], field);
            bool known = false;
            for (const tissue::Reference& reference : tissue::material_references()) known |= source == reference.key;
            EXPECT_TRUE(known) << materials[k].name << " " << field.key << " [" << source << "]";
        }
}

TEST(Materials, JsonHoldsWhatThereIs) {
    const Outcome outcome = run({"materials", "fat", "--json"});
    ASSERT_EQ(outcome.code, 0) << outcome.output;
    const auto json = nlohmann::json::parse(outcome.output);
    ASSERT_EQ(json["materials"].size(), 1u);
    const auto& values = json["materials"][0]["values"];
    EXPECT_EQ(values.size(), tissue::material_fields().size());
    EXPECT_NEAR(values["density_kg_per_m3"]["value"].get<double>(), 911.0, 1e-9);
    EXPECT_NEAR(values["perfusion_ml_per_min_kg"]["value"].get<double>(), 33.0, 1e-9);
    EXPECT_TRUE(json["references"].contains(values["density_kg_per_m3"]["source"].get<std::string>()));
}

TEST(Materials, UnknownTissueIsToldTheNearest) {
    const Outcome outcome = run({"materials", "fatt"});
    EXPECT_EQ(outcome.code, 2);
    EXPECT_NE(outcome.output.find("did you mean \"fat\"?"), std::string::npos) << outcome.output;
}

TEST(Materials, DocumentIsWhatTheProgramPrints) {
    const Outcome outcome = run({"materials"});
    ASSERT_EQ(outcome.code, 0);
    const std::string document = read_file(CALOT_SOURCE_DIR "/docs/materials.md");
    EXPECT_NE(document.find("```\n" + outcome.output + "```"), std::string::npos)
        << "docs/materials.md is out of date: put the output of `calot materials` between its fences";
}

TEST(Materials, ImplausibleValuesGetAWarning) {
    const Folder folder("materials");
    const std::string scene = folder.write("stiff.toml",
                                           "[anatomy]\nkind = \"block\"\n[[script.key]]\nt = 0\n"
                                           "[materials.fat]\nthermal_conductivity_W_per_mK = 40.0\n");
    const Outcome outcome = run({"inspect", scene});
    EXPECT_EQ(outcome.code, 0) << outcome.output;
    EXPECT_NE(outcome.output.find("stiff.toml:6"), std::string::npos) << outcome.output;
    EXPECT_NE(outcome.output.find("soft tissue lies in 0.15 to 0.65 W/(m K)"), std::string::npos) << outcome.output;
}

}  // namespace calot::test
