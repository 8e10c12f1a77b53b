#include "report.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <map>
#include <sstream>

#include <fmt/format.h>

#include "calot/base/units.h"
#include "html.h"
#include "plot.h"
#include "report_style.h"

namespace calot::app {

namespace {

std::string embedded_png(const std::string& path) {
    std::ifstream stream(path, std::ios::binary);
    std::ostringstream bytes;
    bytes << stream.rdbuf();
    return data_url("image/png", bytes.str());
}

std::string figure(const std::string& value, const std::string& what) {
    return fmt::format("<div><b>{}</b><span>{}</span></div>", value, escaped(what));
}
std::string row(const std::string& what, const std::string& value) {
    return fmt::format("<tr><th>{}</th><td>{}</td></tr>", escaped(what), value);
}

std::string opening(const RunRecord& r, const RunPlan& plan) {
    std::string out = fmt::format("<h1>{}</h1>\n<p class=\"lead\">", escaped(r.scene));
    if (!plan.scene.description.empty()) out += escaped(plan.scene.description) + " ";
    out += fmt::format("{:.4g} seconds of electrosurgery, simulated by Calot {}.</p>\n", r.duration_s, CALOT_VERSION);
    if (r.interrupted)
        out += fmt::format(
            "<p class=\"note\">The run was interrupted after {:.2f} s. Everything below is what happened until "
            "then.</p>\n",
            r.duration_s);
    if (!r.status.ok)
        out += fmt::format(
            "<p class=\"note\">The simulation stopped at tick {}: {} was no longer finite. Everything below is what "
            "happened until then.</p>\n",
            r.status.tick, escaped(r.status.field));
    for (const std::string& note : r.notes) out += fmt::format("<p class=\"note\">{}</p>\n", escaped(note));
    return out;
}

/// The video, or a still in its place.
std::string hero(const RunRecord& r, const std::string& directory) {
    const std::string poster =
        r.stills.empty() ? "" : embedded_png(directory + "/" + r.stills[r.stills.size() / 2].file);
    if (r.video.empty() && poster.empty()) return "";
    if (r.video.empty()) return fmt::format("<img class=\"hero\" alt=\"the middle of the run\" src=\"{}\">\n", poster);
    return fmt::format("<video class=\"hero\" src=\"{}\" poster=\"{}\" controls loop muted playsinline></video>\n",
                       r.video, poster);
}

std::string stills(const RunRecord& r, const std::string& directory) {
    if (r.stills.empty()) return "";
    std::string out = "<h2>What the laparoscope saw</h2>\n<div class=\"stills\">\n";
    for (const Still& still : r.stills)
        out += fmt::format("<figure><img alt=\"at {:.2f} s\" src=\"{}\"><figcaption>{:.2f} s</figcaption></figure>\n",
                           still.time_s, embedded_png(directory + "/" + still.file), still.time_s);
    return out + "</div>\n";
}

std::string key_figures(const RunRecord& r) {
    std::string out = "<div class=\"figures\">";
    out += figure(fmt::format("{:.3g} ml", r.last.volume_removed_m3 * 1e6), "of tissue removed");
    out += figure(fmt::format("{:.0f} °C", celsius_from_kelvin(r.max_temperature_K)), "hottest tissue");
    out += figure(fmt::format("{:.2g} N", r.force_N.max()), "greatest force on the hook");
    out += figure(fmt::format("{:.3g} J", r.last.energy_J.delivered), "delivered by the generator");
    out += figure(r.injuries.empty() ? "<em class=\"good\">none</em>"
                                     : fmt::format("<em class=\"bad\">{}</em>", r.injuries.size()),
                  "structures injured");
    out += figure(fmt::format("{:.3g} ms", r.tick_us.at(0.5) * 1e-3), "to compute a tick of 1 ms (median)");
    return out + "</div>\n";
}

std::string injuries(const RunRecord& r) {
    if (r.injuries.empty())
        return "<p class=\"good\">Neither duct nor artery nor anything else but fat was injured.</p>\n";
    std::string out =
        "<table><tr><th>Structure</th><th>burnt away</th><th>irreversibly heated</th><th>hottest</th><th>first "
        "at</th></tr>\n";
    for (const Injury& injury : r.injuries)
        out += fmt::format(
            "<tr><td class=\"bad\">{}</td><td>{} hexels</td><td>{} hexels</td><td>{:.0f} °C</td><td>{:.2f} "
            "s</td></tr>\n",
            escaped(injury.structure), grouped(injury.hexels_removed), grouped(injury.hexels_damaged),
            celsius_from_kelvin(injury.max_temperature_K), injury.first_time_s);
    return out + "</table>\n";
}

/// Points of a run with a task, part by part.
std::string points(const RunRecord& r) {
    if (!r.scored) return "";
    const training::Score& score = r.scored->score;
    std::string out = fmt::format("<h2>{}: {:.0f} of 100 points</h2>\n", escaped(r.scored->task.title), score.points);
    for (const training::BrokenLimit& limit : score.broken)
        out += fmt::format("<p class=\"bad\">{}: at most {:.0f} points.</p>\n", escaped(limit.message), limit.cap);
    out += "<table><tr><th>Measure</th><th>value</th><th>points</th></tr>\n";
    for (const training::ScorePart& part : score.parts) {
        const training::Metric& metric = *training::find_metric(part.metric);
        out += fmt::format("<tr><td title=\"{}\">{}</td><td>{}</td><td>{:.1f} of {:.1f}</td></tr>\n",
                           escaped(metric.formula), escaped(metric.title),
                           part.known ? training::shown(metric, part.value) : "not in this scene", part.points,
                           part.weight);
    }
    return out + "</table>\n";
}

/// Spans of time with the pedal down, from the rows.
std::vector<std::pair<double, double>> pedal_spans(const std::vector<TimelineRow>& rows) {
    std::vector<std::pair<double, double>> spans;
    bool down = false;
    for (const TimelineRow& row : rows) {
        if (row.pedal && !down) spans.emplace_back(row.time_s, row.time_s);
        if (row.pedal) spans.back().second = row.time_s;
        down = row.pedal;
    }
    return spans;
}

template <class F>
Series series(const std::vector<TimelineRow>& rows, const std::string& name, const std::string& colour, F value) {
    Series out{name, colour, {}};
    for (const TimelineRow& row : rows) out.points.emplace_back(row.time_s, value(row));
    return out;
}

std::string plots(const RunRecord& r) {
    Plot base;
    base.shaded = pedal_spans(r.rows);
    base.x_max = std::max(1e-3, r.duration_s);
    auto make = [&](const char* title, const char* unit, std::vector<Series> lines) {
        Plot plot = base;
        plot.title = title;
        plot.unit = unit;
        plot.series = std::move(lines);
        return plot;
    };
    std::string out = "<h2>What happened</h2>\n<p>Shaded: the pedal is down.</p>\n<div class=\"plots\">\n";
    Plot force =
        make("Force on the hook", "N",
             {series(r.rows, "force", "var(--blue)", [](const TimelineRow& t) { return glm::length(t.force_N); })});
    force.y_floor = 0.05;
    out += svg(force);
    Plot hot = make("Hottest tissue", "°C", {series(r.rows, "now", "var(--red)", [](const TimelineRow& t) {
                        return celsius_from_kelvin(t.max_temperature_K);
                    })});
    hot.y_floor = 110.0;
    hot.marks = {{100.0, "water boils"}};
    out += svg(hot);
    Plot power =
        make("Power into tissue", "W",
             {series(r.rows, "delivered", "var(--warm)", [](const TimelineRow& t) { return t.generator.power_W; }),
              series(r.rows, "set", "var(--grey)", [](const TimelineRow& t) { return t.power_setting_W; })});
    power.y_floor = 1.0;
    out += svg(power);
    Plot impedance = make(
        "Impedance", "Ohm",
        {series(r.rows, "impedance", "var(--violet)", [](const TimelineRow& t) { return t.generator.impedance_Ohm; })});
    impedance.logarithmic = true;
    out += svg(impedance);
    Plot volume = make(
        "Volume removed", "mm³",
        {series(r.rows, "volume", "var(--green)", [](const TimelineRow& t) { return t.volume_removed_m3 * 1e9; })});
    volume.y_floor = 1.0;
    out += svg(volume);
    Plot gas = make("Steam and smoke given off", "mg",
                    {series(r.rows, "gas", "var(--teal)", [](const TimelineRow& t) { return t.emitted_kg * 1e6; })});
    gas.y_floor = 0.1;
    out += svg(gas);
    return out + "</div>\n";
}

/// A table of what each press of the pedal did.
std::string activations(const RunRecord& r) {
    if (r.activations.empty()) return "";
    static constexpr std::array<const char*, 3> kModes{"cut", "blend", "coag"};
    std::string out =
        "<h2>Heat beside the cut</h2>\n<p>How far from the edge of what was burnt away (or from where metal touched, "
        "marked °, when nothing was) tissue reached 45, 50 and 60 °C, and how far it was irreversibly damaged, for "
        "each "
        "press of the pedal. Distances are whole hexels.</p>\n<table><tr><th>from</th><th>for</th><th>generator</th>"
        "<th>energy</th><th>burnt away</th><th>45 °C</th><th>50 °C</th><th>60 °C</th><th>damaged</th><th>wire "
        "after</th></tr>\n";
    for (const simulation::Activation& a : r.activations) {
        out += fmt::format("<tr><td>{:.2f} s</td><td>{:.2f} s</td><td>{} {:g} W</td><td>{:.1f} J</td><td>{}{}</td>",
                           a.start_s, a.stop_s - a.start_s, kModes[static_cast<std::size_t>(a.mode)], a.power_setting_W,
                           a.energy_J, grouped(a.hexels_removed), a.from_cut ? "" : "°");
        for (const double spread_m : a.spread_m)
            out += spread_m > 0.0 ? fmt::format("<td>{:.1f} mm</td>", spread_m * 1e3) : "<td>–</td>";
        out += fmt::format("<td>{:.0f} °C</td></tr>\n", celsius_from_kelvin(a.tip_temperature_K));
    }
    return out + "</table>\n";
}

std::string energy(const RunRecord& r) {
    const tissue::EnergyBudget& e = r.last.energy_J;
    return fmt::format(
               "<h2>Where the energy went</h2>\n<p>The generator delivered {:.4g} J. What the account does not explain "
               "is {:.1e} of it.</p>\n",
               e.delivered, std::abs(r.energy_imbalance)) +
           svg_stack({{"latent: water boiled, solids gasified", "var(--red)", e.latent},
                      {"carried off hot by gas", "var(--warm)", e.gas - e.latent},
                      {"still in the tissue, as heat", "var(--gold)", r.last.stored_J},
                      {"to gas and organs at the surface", "var(--green)", e.surface},
                      {"to blood", "var(--teal)", e.perfusion},
                      {"beyond the field's window", "var(--blue)", e.outflow},
                      {"gone with pieces that fell", "var(--grey)", e.debris},
                      {"in the hook", "var(--soft)", e.tip + e.transit}},
                     "J");
}

/// Where the current went: what was not meant for it is what injures.
std::string current(const RunRecord& r) {
    std::string out =
        "<h2>Where the current went</h2>\n<table><tr><th>Tissue</th><th>heat by current</th><th>highest current "
        "density</th></tr>\n";
    for (const Conductor& conductor : r.conductors)
        out += fmt::format("<tr><td>{}</td><td>{:.3g} J</td><td>{:.3g} mA/mm²</td></tr>\n", escaped(conductor.name),
                           r.last.stray.energy_J[conductor.material],
                           r.last.stray.highest_density_A_per_m2[conductor.material] * 1e-3);
    return out + fmt::format("</table>\n<p>Voltage times current is heat and outflow to {:.1e} of it.</p>\n",
                             r.last.field.imbalance);
}

/// "duct_length_mm" 28.69 -> "duct length", "28.7 mm"
std::string fact_row(std::string name, double value) {
    static const std::map<std::string, std::string> units{{"_mm", "mm"}, {"_deg", "°"}, {"_ml", "ml"}};
    std::string text = fmt::format("{:.3g}", value);
    bool has_unit = false;
    for (const auto& [ending, unit] : units)
        if (!has_unit && name.size() > ending.size() &&
            name.compare(name.size() - ending.size(), ending.size(), ending) == 0) {
            name.resize(name.size() - ending.size());
            text += " " + unit;
            has_unit = true;
        }
    if (!has_unit && (value == 0.0 || value == 1.0)) text = value == 1.0 ? "yes" : "no";
    std::replace(name.begin(), name.end(), '_', ' ');
    return row(name, text);
}

std::string details(const RunRecord& r, const RunPlan& plan) {
    std::string run = "<table>";
    run += row("tissue", fmt::format("{} hexels of {:g} mm, {} phyxels", grouped(r.hexels_initial),
                                     plan.setup->model.hexels.spacing_m * 1e3, grouped(r.phyxels_initial)));
    run += row("removed", fmt::format("{} hexels burnt, {} fallen, {} links severed, {} phyxels gone",
                                      grouped(r.last.hexels_burnt), grouped(r.last.hexels_fallen),
                                      grouped(r.last.links_severed), grouped(r.phyxels_removed)));
    run += row("surface", fmt::format("{} triangles, {}", grouped(static_cast<std::int64_t>(r.surface_triangles)),
                                      r.surface_closed ? "closed" : "<span class=\"bad\">not closed</span>"));
    run += row("computing", fmt::format("tick {:.3f} ms median, {:.3f} ms at 99 %; {}, {} threads; {:.1f} s in all",
                                        r.tick_us.at(0.5) * 1e-3, r.tick_us.at(0.99) * 1e-3, escaped(r.backend),
                                        r.threads, r.wall_s));
    for (int k = 0; k < simulation::kStages; ++k)
        run += row(fmt::format("· {}", simulation::kStageNames[k]),
                   fmt::format("{:.1f} µs mean",
                               r.stages_us[k].sum() / static_cast<double>(std::max<std::int64_t>(1, r.ticks))));
    if (!r.renderer.empty()) run += row("drawn by", escaped(r.renderer));
    run += row("state hash", fmt::format("<code>{:016x}</code>", r.state_hash));
    run += "</table>";
    std::string patient = "<table>" + row("seed", fmt::format("{}", r.seed));
    for (const auto& [name, value] : plan.setup->anatomy.facts)
        if (name != "seed") patient += fact_row(name, value);
    patient += "</table>";
    return "<div class=\"columns\"><section><h2>The run</h2>" + run + "</section><section><h2>The patient</h2>" +
           patient + "</section></div>\n";
}

constexpr const char* kAbout = R"(<h2>What Calot is</h2>
<p>Calot simulates electrosurgery on soft tissue: here, how a hook that carries radio-frequency current frees the cystic duct and the
cystic artery from the fat of Calot's triangle, the step of a gallbladder operation in which most injuries happen. Nothing is
scripted but the hand and the foot. The tissue is divided into fine <em>hexels</em>, which carry electric current, heat up, boil dry, char
and turn to smoke, and coarser <em>phyxels</em>, which stretch and move, and whose links part where hexels are gone. Force, current,
temperature and smoke all follow from that. The same scene gives the same bytes on every run.</p>
<p>It is a research and training tool, not a medical device.</p>
)";

std::string files(const RunRecord& r) {
    std::string out = "<h2>Files beside this page</h2>\n<table>";
    auto tell = [&](const char* file, const char* what) {
        for (const std::string& written : r.files)
            if (written == file)
                out += fmt::format("<tr><td><a href=\"{0}\"><code>{0}</code></a></td><td>{1}</td></tr>", file, what);
    };
    tell("summary.json", "all figures of this page, for programs");
    tell("timeline.csv", "position, force, power, temperature, removal and energy every 10 ms");
    tell("dissection.mp4", "the video");
    tell("frames/", "the stills");
    tell("surface.pvd", "the tissue's surface in time, for ParaView");
    tell("recording.calot", "the run itself: <code>calot replay recording.calot --verify</code>");
    return out + "</table>\n";
}

}  // namespace

std::string report_html(const RunRecord& record, const RunPlan& plan, const std::string& directory) {
    std::string out =
        "<!doctype html>\n<html lang=\"en\">\n<head><meta charset=\"utf-8\"><meta name=\"viewport\" "
        "content=\"width=device-width,initial-scale=1\">\n";
    out += fmt::format("<title>{} · Calot</title>\n<style>{}</style></head>\n<body><main>\n", escaped(record.scene),
                       kReportStyle);
    out += opening(record, plan);
    out += hero(record, directory);
    out += key_figures(record);
    out += injuries(record);
    out += points(record);
    out += kAbout;
    out += stills(record, directory);
    out += plots(record);
    out += activations(record);
    out += energy(record);
    out += current(record);
    out += details(record, plan);
    out += files(record);
    out += fmt::format("<footer>Calot {} · scene “{}”, seed {} · {} ticks</footer>\n</main></body></html>\n",
                       CALOT_VERSION, escaped(record.scene), record.seed, record.ticks);
    return out;
}

}  // namespace calot::app
