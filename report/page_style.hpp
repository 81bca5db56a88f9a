// SPDX-License-Identifier: GPL-3.0-or-later
// The look of the report's page: quiet type, room around figures, light and dark, A4.
#pragma once

namespace clerestory {

inline constexpr const char* pageStyle = R"css(
:root{color-scheme:light dark;--paper:#fdfcfa;--ink:#1d1c1a;--soft:#68645e;--line:#e3dfd7;--tint:#f4f1eb;--accent:#9a5b13;
--wall:#8b867d;--floor:#eeebe4;--glass:#3f93c4}
@media (prefers-color-scheme:dark){:root{--paper:#161514;--ink:#ebe8e2;--soft:#a19c93;--line:#34312d;--tint:#201e1c;
--accent:#e0a458;--wall:#77726a;--floor:#2a2825;--glass:#6fb9e3}}
*{box-sizing:border-box}
html{-webkit-text-size-adjust:100%}
body{margin:0;background:var(--paper);color:var(--ink);font:400 16px/1.55 system-ui,-apple-system,"Segoe UI",Roboto,
"Helvetica Neue","Noto Sans","Liberation Sans",Arial,sans-serif;font-variant-numeric:tabular-nums lining-nums}
main,header,footer{max-width:1000px;margin:0 auto;padding:0 32px}
header{padding-top:72px}
h1,h2,h3{font-weight:600;line-height:1.2;letter-spacing:-.012em;overflow-wrap:anywhere}
h1{font-size:2.6rem;font-weight:300;margin:.2em 0 .35em;letter-spacing:-.022em}
h2{font-size:1.55rem;font-weight:400;margin:0 0 1.1rem}
h3{font-size:1.02rem;margin:2.4rem 0 .7rem}
p{max-width:44em;margin:.7em 0}
a{color:inherit;text-decoration-color:var(--accent);text-underline-offset:.2em}
.over{color:var(--accent);font-size:.82rem;font-weight:600;letter-spacing:.09em;text-transform:uppercase;margin:0}
.lead{font-size:1.12rem;color:var(--soft);max-width:40em}
.note,figcaption,.u,.faint{color:var(--soft)}
.note,figcaption{font-size:.88rem}
section{margin:84px 0;padding-top:26px;border-top:1px solid var(--line)}
nav{margin:26px 0 0;font-size:.93rem}
nav ul{list-style:none;display:flex;flex-wrap:wrap;gap:6px 22px;margin:0;padding:0}
figure{margin:30px 0}
figure img{display:block;width:100%;height:auto;background:var(--tint)}
figcaption{margin-top:10px;max-width:52em}
.views figure:first-child{margin-top:44px}
.views .rest{display:grid;grid-template-columns:repeat(auto-fit,minmax(300px,1fr));gap:24px}
.views .rest figure{margin:0}
dl.figures{display:grid;grid-template-columns:repeat(auto-fill,minmax(190px,1fr));gap:26px 28px;margin:26px 0 34px}
dl.figures dt{font-size:.84rem;color:var(--soft);line-height:1.35}
dl.figures dd{margin:2px 0 0;font-size:1.6rem;font-weight:300;letter-spacing:-.01em;white-space:nowrap}
dl.figures .u{font-size:.95rem;font-weight:400}
.table{overflow-x:auto;margin:30px 0}
.table:focus-visible{outline:2px solid var(--accent);outline-offset:4px}
table{border-collapse:collapse;width:100%;font-size:.9rem;line-height:1.4}
caption{text-align:left;font-weight:600;font-size:1.02rem;padding:0 0 10px}
th,td{text-align:left;padding:7px 14px 7px 0;vertical-align:baseline;font-weight:400;border-bottom:1px solid var(--line);
overflow-wrap:anywhere}
thead th{color:var(--soft);font-size:.82rem;line-height:1.3;vertical-align:bottom;border-bottom:1px solid var(--soft);
overflow-wrap:normal}
.n{text-align:right;padding-left:14px;padding-right:0;white-space:nowrap}
thead .n{white-space:normal}
tbody th:not(.n),tbody td:not(.n){min-width:5.6em}
.n+th:not(.n),.n+td:not(.n){padding-left:26px}
thead .u{display:block}
.swatch{display:inline-block;width:1.05em;height:1.05em;margin-right:.6em;vertical-align:-.16em;border-radius:2px;
box-shadow:inset 0 0 0 1px rgba(128,128,128,.45)}
svg{display:block;width:100%;height:auto;font-size:11px}
svg text{fill:var(--ink);font-family:inherit}
svg text.faint,svg .unit,svg .right,svg .tick{fill:var(--soft)}
svg .tick,svg .on-light,svg .on-dark{text-anchor:middle}
svg .right{text-anchor:end}
svg .on-light,svg .on-dark{font-size:10px;pointer-events:none}
svg .on-light{fill:#1d1c1a}
svg .on-dark{fill:#fff}
.plan .wall{fill:var(--wall);stroke:var(--wall);stroke-linejoin:miter}
.plan .floor{fill:var(--floor);stroke:var(--floor);stroke-width:.8}
.plan .sensors{shape-rendering:crispEdges}
.plan .sensors rect:hover{stroke:var(--ink);stroke-width:2}
.plan .window{fill:none;stroke:var(--glass);stroke-width:4}
.plan .bar{fill:none;stroke:var(--soft)}
.north circle{fill:none;stroke:var(--soft)}
.north path{fill:var(--ink)}
.chart{max-width:720px;font-size:12px}
.chart .gridline{stroke:var(--line)}
.chart .line{fill:none;stroke:var(--accent);stroke-width:1.6}
.chart circle{fill:var(--accent)}
ul.list{list-style:none;margin:14px 0;padding:0;max-width:52em}
ul.list li{padding:9px 0;border-bottom:1px solid var(--line)}
code,pre{font:.9em/1.5 ui-monospace,"SF Mono",Menlo,Consolas,"Liberation Mono",monospace}
pre{background:var(--tint);padding:16px 20px;overflow-x:auto}
.hash{overflow-wrap:anywhere}
.yes{font-weight:600}
footer{padding-top:8px;padding-bottom:72px;color:var(--soft);font-size:.88rem}
@media (max-width:640px){main,header,footer{padding-left:20px;padding-right:20px}header{padding-top:40px}
h1{font-size:2rem}section{margin:56px 0}}
@page{size:A4;margin:17mm 16mm 18mm}
@media print{:root{color-scheme:light;--paper:#fff;--ink:#000;--soft:#55524d;--line:#d5d1ca;--tint:#f5f3ef;--accent:#8a4f0c;
--wall:#8b867d;--floor:#eeebe4;--glass:#3f93c4}
*{-webkit-print-color-adjust:exact;print-color-adjust:exact}
body{font-size:10pt}main,header,footer{max-width:none;padding:0}header{padding-top:0}nav{display:none}
section{margin:12mm 0 0;padding-top:6mm}
.room,.break{break-before:page;margin-top:0;padding-top:0;border-top:0}
h2,h3,caption{break-after:avoid}figure,dl.figures,tr,li,pre{break-inside:avoid}
thead{display:table-header-group}.table{overflow:visible;margin:7mm 0}
table{font-size:8.6pt}dl.figures{grid-template-columns:repeat(4,1fr);gap:5mm 6mm}dl.figures dd{font-size:15pt}
svg.plan{max-height:112mm}a{text-decoration:none}}
)css";

}  // namespace clerestory
