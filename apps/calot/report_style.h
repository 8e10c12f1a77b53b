#pragma once
// The look of the report. Light and dark by the reader's preference; no fonts, scripts or images from elsewhere.

namespace calot::app {

inline constexpr const char* kReportStyle = R"css(
:root{color-scheme:light dark;--paper:#faf8f5;--card:#fff;--ink:#1f1b16;--soft:#6b6358;--line:#e4ded5;--shade:#f6c56733;
--red:#b3372b;--warm:#d9822b;--gold:#c9a227;--green:#4d8a5b;--teal:#2a8a8c;--blue:#3c6fb0;--violet:#7a5aa6;--grey:#8d867b}
@media (prefers-color-scheme:dark){:root{--paper:#16130f;--card:#201c17;--ink:#f0eae1;--soft:#a89f92;--line:#38322a;--shade:#f6c5671f;
--red:#e5695b;--warm:#eb9f4f;--gold:#e0bf52;--green:#79b888;--teal:#5fbcbd;--blue:#7ba6df;--violet:#ab8fd4;--grey:#9b9488}}
*{box-sizing:border-box}
body{margin:0;background:var(--paper);color:var(--ink);font:16px/1.55 system-ui,-apple-system,"Segoe UI",sans-serif}
main{max-width:1180px;margin:0 auto;padding:40px 24px 64px}
h1{font:600 40px/1.1 Georgia,"Times New Roman",serif;margin:0 0 6px;letter-spacing:-.01em}
h2{font:600 22px/1.2 Georgia,"Times New Roman",serif;margin:44px 0 14px}
p{max-width:74ch;margin:0 0 12px}.lead{font-size:18px;color:var(--soft);margin-bottom:24px}
a{color:var(--blue)}code{font:14px ui-monospace,Menlo,Consolas,monospace;overflow-wrap:anywhere}
.hero{width:100%;border-radius:14px;background:#000;display:block;max-height:74vh;object-fit:contain}
.stills{display:grid;grid-template-columns:repeat(auto-fill,minmax(min(100%,260px),1fr));gap:14px}
.stills figure{margin:0}.stills img{width:100%;border-radius:10px;display:block;background:#000}
.stills figcaption{color:var(--soft);font-size:14px;padding:4px 2px}
.figures{display:grid;grid-template-columns:repeat(auto-fill,minmax(170px,1fr));gap:12px;margin:24px 0}
.figures div{background:var(--card);border:1px solid var(--line);border-radius:12px;padding:14px 16px}
.figures em{font-style:normal}.figures b{display:block;font:600 25px/1.2 Georgia,serif}.figures span{color:var(--soft);font-size:14px}
.plots{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(100%,470px),1fr));gap:14px}
.plot{margin:0;background:var(--card);border:1px solid var(--line);border-radius:12px;padding:12px 14px 4px}
.plot figcaption{font-weight:600}.plot figcaption span{color:var(--soft);font-weight:400;margin-right:10px}
.plot figcaption i{font-style:normal;font-weight:400;font-size:14px;margin-left:10px}
.plot figcaption i::before,.legend li::before{content:"";display:inline-block;width:11px;height:11px;border-radius:3px;background:var(--c);margin-right:6px;flex:none}
svg{display:block;width:100%;height:auto}svg text{fill:var(--soft);font:12px system-ui,sans-serif}
svg .y,svg .m{text-anchor:end}svg .x{text-anchor:middle}svg path{fill:none;stroke-width:1.7;stroke-linejoin:round}
.grid{stroke:var(--line)}.mark{stroke:var(--soft);stroke-dasharray:3 4}.pedal{fill:var(--shade)}
.stack{height:36px;border-radius:8px;overflow:hidden}
.legend{list-style:none;display:grid;grid-template-columns:repeat(auto-fill,minmax(min(100%,340px),1fr));gap:6px 36px;padding:0;margin:16px 0}
.legend li{display:flex;align-items:baseline;gap:10px}.legend b{margin-left:auto;font-weight:600;white-space:nowrap}
.legend span{white-space:nowrap;color:var(--soft);min-width:52px;text-align:right}
table{border-collapse:collapse;width:100%;max-width:760px}th{white-space:nowrap}td,th{text-align:left;padding:6px 14px 6px 0;border-bottom:1px solid var(--line);vertical-align:top}
td+td{font-variant-numeric:tabular-nums}th{color:var(--soft);font-weight:500}
.good{color:var(--green)}.bad{color:var(--red)}.note{border-left:4px solid var(--warm);padding:8px 14px;background:var(--card);border-radius:0 8px 8px 0}
.columns{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(100%,420px),1fr));gap:0 40px}
footer{margin-top:48px;padding-top:16px;border-top:1px solid var(--line);color:var(--soft);font-size:14px}
)css";

}  // namespace calot::app
