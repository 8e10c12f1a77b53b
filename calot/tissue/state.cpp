#include "calot/tissue/state.h"

#include "calot/base/hash.h"

namespace calot::tissue {

State State::make(const Model& model) {
    State state;
    const auto phyxels = static_cast<std::size_t>(model.phyxels.cells);
    const auto hexels = static_cast<std::size_t>(model.hexels.cells);
    for (int axis = 0; axis < 3; ++axis) {
        state.displacement_m[axis].assign(phyxels, 0.0f);
        state.velocity_m_per_s[axis].assign(phyxels, 0.0f);
    }
    state.phyxel_present = model.phyxel_initial;
    state.hexel_present = model.hexel_initial;
    state.tip.temperature_K = model.thermal.body_temperature_K;
    state.enthalpy_J_per_m3.assign(hexels, 0.0f);
    state.water_kg_per_m3.assign(hexels, 0.0f);
    state.peak_temperature_K.assign(hexels, static_cast<float>(model.thermal.body_temperature_K));
    state.damage.assign(hexels, 0.0f);
    for (std::size_t h = 0; h < hexels; ++h) {
        const Material& material = model.materials[model.hexel_material[h]];
        if (model.hexel_material[h] != kNoMaterial)
            state.water_kg_per_m3[h] = static_cast<float>(material.density_kg_per_m3 * material.water_mass_fraction);
    }
    // A link lives where both ends are phyxels or ghosts, not both ghosts.
    // deformation::make_work severs those that the anatomy itself does not carry.
    for (std::size_t d = 0; d < kLinkDirections.size(); ++d) {
        state.links[d] = BitArray(model.phyxels.cells);
        const std::int64_t offset = model.phyxels.offset(kLinkDirections[d]);
        for (std::int64_t p = model.phyxels.first; p < model.phyxels.last; ++p) {
            const bool real_here = model.phyxel_initial.test(p), real_there = model.phyxel_initial.test(p + offset);
            const bool here = real_here || model.phyxel_ghost.test(p), there = real_there || model.phyxel_ghost.test(p + offset);
            if (here && there && (real_here || real_there)) state.links[d].set(p);
        }
    }
    const auto window = static_cast<std::size_t>(model.electric.window_cells);
    state.potential.assign(window * window * window, 0.0f);
    state.joule_S_per_m3.assign(window * window * window, 0.0f);
    return state;
}

namespace {

template <class T>
Field array_field(const char* name, Array<T>& array) {
    return {name, array.data(), array.size() * sizeof(T)};
}
Field bits_field(const char* name, BitArray& bits) { return array_field(name, bits.words()); }
template <class T>
Field scalar_field(const char* name, T& value) {
    return {name, &value, sizeof(T)};
}

}  // namespace

std::vector<Field> fields(State& s) {
    std::vector<Field> all{
        scalar_field("tick", s.tick),
        array_field("displacement_x", s.displacement_m[0]),
        array_field("displacement_y", s.displacement_m[1]),
        array_field("displacement_z", s.displacement_m[2]),
        array_field("velocity_x", s.velocity_m_per_s[0]),
        array_field("velocity_y", s.velocity_m_per_s[1]),
        array_field("velocity_z", s.velocity_m_per_s[2]),
    };
    static constexpr std::array<const char*, 9> kLinkNames{"links_0", "links_1", "links_2", "links_3", "links_4",
                                                           "links_5", "links_6", "links_7", "links_8"};
    for (std::size_t d = 0; d < 9; ++d) all.push_back(bits_field(kLinkNames[d], s.links[d]));
    all.push_back(bits_field("phyxel_present", s.phyxel_present));
    all.push_back(bits_field("hexel_present", s.hexel_present));
    all.push_back(array_field("enthalpy", s.enthalpy_J_per_m3));
    all.push_back(array_field("water", s.water_kg_per_m3));
    all.push_back(array_field("peak_temperature", s.peak_temperature_K));
    all.push_back(array_field("damage", s.damage));
    all.push_back(scalar_field("field_low", s.field_low));
    all.push_back(array_field("potential", s.potential));
    all.push_back(array_field("joule", s.joule_S_per_m3));
    all.push_back(scalar_field("field", s.field));
    all.push_back(scalar_field("stray_heat", s.stray_S));
    all.push_back(scalar_field("stray_density", s.stray_density_S_per_m2));
    all.push_back(scalar_field("stray", s.stray));
    all.push_back(scalar_field("generator", s.generator));
    all.push_back(scalar_field("tip", s.tip));
    all.push_back(scalar_field("energy", s.energy_J));
    all.push_back(scalar_field("hexels_burnt", s.hexels_burnt));
    all.push_back(scalar_field("hexels_fallen", s.hexels_fallen));
    all.push_back(scalar_field("links_severed", s.links_severed));
    all.push_back(scalar_field("hook_force", s.hook_force_N));
    all.push_back(scalar_field("hook_pose", s.hook));
    return all;
}

std::vector<std::uint64_t> hash_fields(const State& state) {
    std::vector<std::uint64_t> hashes;
    for (const Field& field : fields(const_cast<State&>(state))) hashes.push_back(hash_bytes(field.data, field.bytes));
    return hashes;
}

std::uint64_t hash(const State& state) {
    const std::vector<std::uint64_t> hashes = hash_fields(state);
    return hash_bytes(hashes.data(), hashes.size() * sizeof(std::uint64_t));
}

}  // namespace calot::tissue
