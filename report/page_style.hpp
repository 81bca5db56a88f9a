// SPDX-License-Identifier: GPL-3.0-or-later
// The look of the report's page: quiet type, room around figures, light and dark, A4.
#pragma once

namespace clerestory {

inline constexpr const char* pageStyle = R"css(
:root{color-scheme:light dark;--paper:#fdfcfa;--ink:#1d1c1a;--soft:#68645e;--line:#e3dfd7;--tint:#f4f1eb;--accent:#9a5b13;
--wall:#8b867d;--floor:#eeebe4;--glass:#3f93c4;--yes:#1f6b3a;--no:#a3261b}
@media (prefers-color-scheme:dark){:root:not([data-theme=light]){--paper:#161514;--ink:#ebe8e2;--soft:#a19c93;--line:#34312d;--tint:#201e1c;
--accent:#e0a458;--wall:#77726a;--floor:#2a2825;--glass:#6fb9e3;--yes:#7ccf98;--no:#ff9d8f}}
:root[data-theme=light]{color-scheme:light}
:root[data-theme=dark]{color-scheme:dark;--paper:#161514;--ink:#ebe8e2;--soft:#a19c93;--line:#34312d;--tint:#201e1c;
--accent:#e0a458;--wall:#77726a;--floor:#2a2825;--glass:#6fb9e3;--yes:#7ccf98;--no:#ff9d8f}
*{box-sizing:border-box}
html{-webkit-text-size-adjust:100%}
body{margin:0;background:var(--paper);color:var(--ink);font:400 16px/1.55 system-ui,-apple-system,"Segoe UI",Roboto,
"Helvetica Neue","Noto Sans","Liberation Sans",Arial,sans-serif;font-variant-numeric:tabular-nums lining-nums}
main,header,footer{max-width:1180px;margin:0 auto;padding:0 32px}
header{padding-top:44px}
h1,h2,h3{font-weight:600;line-height:1.2;letter-spacing:-.012em;overflow-wrap:anywhere}
h1{font-size:2.4rem;font-weight:300;margin:.15em 0 .25em;letter-spacing:-.022em}
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
.first{display:grid;grid-template-columns:minmax(0,2fr) minmax(0,1fr);gap:40px;align-items:start;margin-top:10px}
.first figure,.glance .table{margin:0}
.views{margin-top:26px}
.rest{margin-top:30px;display:grid;grid-template-columns:repeat(auto-fit,minmax(min(420px,100%),1fr));gap:24px}
.rest figure{margin:0}
@media (min-width:901px){.views .rest figure:only-child{max-width:calc((100% - 40px)*2/3)}}
summary{cursor:pointer;font-size:.95rem}
.falsecolours{margin-top:26px}
dl.figures{display:grid;grid-template-columns:repeat(auto-fill,minmax(min(190px,45%),1fr));gap:26px 28px;margin:26px 0 34px}
dl.figures div{display:flex;flex-direction:column;justify-content:flex-end}
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
tbody th:not(.n){min-width:7.6em}
tbody td:not(.n){min-width:5.6em}
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
svg .on-light{fill:#000}
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
.chart .band{fill:var(--accent);fill-opacity:.14}
ul.list{list-style:none;margin:14px 0;padding:0;max-width:52em}
ul.list li{padding:9px 0;border-bottom:1px solid var(--line)}
code,pre{font:.9em/1.5 ui-monospace,"SF Mono",Menlo,Consolas,"Liberation Mono",monospace}
pre{background:var(--tint);padding:16px 20px;overflow-x:auto}
.hash{overflow-wrap:anywhere}
.yes,.no{font-weight:600;white-space:nowrap}
.yes{color:var(--yes)}
.no{color:var(--no)}
footer{padding-top:8px;padding-bottom:72px;color:var(--soft);font-size:.88rem}
[hidden]{display:none!important}
.unseen{position:absolute}
button,select,input{font:inherit;color:inherit}
button:not(.sort),select{background:var(--tint);border:1px solid var(--line);border-radius:4px;padding:4px 10px}
button:not(.sort):hover,select:hover{border-color:var(--soft)}
:focus-visible{outline:2px solid var(--accent);outline-offset:2px}
input[type=range],input[type=checkbox]{accent-color:var(--accent);vertical-align:middle}
button.theme{float:right;font-size:.85rem}
button.sort{background:none;border:0;padding:0;text-align:inherit;cursor:pointer;font-size:inherit;line-height:inherit}
button.sort:hover{color:var(--ink)}
th[aria-sort] .sort{color:var(--ink);font-weight:600}
th[aria-sort=ascending] .sort::after{content:" \2191"}
th[aria-sort=descending] .sort::after{content:" \2193"}
.filter{display:block;margin:30px 0 -18px;font-size:.88rem;color:var(--soft)}
.filter input{background:var(--tint);border:1px solid var(--line);border-radius:4px;padding:4px 8px;margin:0 8px;width:16em;
max-width:60vw}
.paper{display:none}
.fold{margin-top:-14px;font-size:.88rem}
table.folded:not(.filtered) tr.more:not(.chosen,:target){display:none}
tr.chosen th,tr.chosen td,tr:target th,tr:target td{background:var(--tint)}
.readout{min-height:1.6em;font-size:.95rem;margin:.4em 0 0}
.switches{display:flex;gap:22px;font-size:.88rem;margin-bottom:8px}
svg .off{display:none}
.plan .sensors rect.chosen{stroke:var(--ink);stroke-width:2}
.plan .isolux path{fill:none;stroke:#fff;stroke-width:1.3;pointer-events:none}
.plan .isolux path.under{stroke:#1d1c1a;stroke-width:2.6;stroke-opacity:.55}
.exposure{display:block;font-size:.88rem}
.exposure input{margin-right:8px}
.glance h2{font-weight:600;font-size:1.02rem;margin:0}
.glance dl.figures{gap:20px 24px;margin:18px 0 26px}
.first .glance dl.figures{grid-template-columns:repeat(2,minmax(0,1fr));gap:20px 12px}
.glance p{margin:.9em 0 0}
.glance table{font-size:.86rem}
.glance tbody td:not(.n){min-width:0}
.glance tbody th:not(.n){min-width:5em;padding-right:4px}
.glance .n{padding-left:8px}
.glance .n+td:not(.n),.glance .n+th:not(.n){padding-left:12px;padding-right:0}
.exposed img{filter:url(#exposure)}
.controls{display:flex;flex-wrap:wrap;gap:10px 20px;align-items:center;font-size:.88rem;margin-bottom:12px}
.controls input{width:100px}
.controls output{display:inline-block;min-width:4.2em}
.stage{height:min(64vh,600px,100vw);min-height:300px;background:var(--tint)}
.stage canvas{display:block;width:100%;height:100%;touch-action:none}
.legend3d{margin:14px 0;max-width:420px;font-size:.82rem;color:var(--soft)}
.legend3d .bar{height:10px}
.legend3d .ticks{position:relative;height:1.6em}
.legend3d .ticks span{position:absolute;transform:translateX(-50%)}
.picked{margin-top:12px;min-height:4.6em;font-size:.92rem}
.picked dl{display:flex;flex-wrap:wrap;gap:6px 26px;margin:0 0 6px}
.picked dt{font-size:.8rem;color:var(--soft)}
.picked dd{margin:0;overflow-wrap:anywhere}
.picked div{min-width:0}
@media (max-width:900px){.first{grid-template-columns:minmax(0,1fr);gap:20px}.first .glance dl.figures{grid-template-columns:repeat(auto-fill,minmax(150px,1fr))}}
@media (max-width:640px){main,header,footer{padding-left:20px;padding-right:20px}header{padding-top:40px}
h1{font-size:2rem}section{margin:56px 0}figure:has(>svg.plan){overflow-x:auto}svg.plan{min-width:620px}svg.chart{font-size:19px;overflow:visible}
caption{max-width:calc(100vw - 40px)}}
@media (min-width:641px){.filter{position:relative;z-index:1;width:fit-content;margin:30px 0 -56px auto}}
@page{margin:17mm 16mm 18mm;@bottom-right{content:counter(page) " / " counter(pages);font:8pt system-ui,"Liberation Sans",Arial,sans-serif;color:#55524d}}
@media print{:root:root:root{color-scheme:light;--paper:#fff;--ink:#000;--soft:#55524d;--line:#d5d1ca;--tint:#f5f3ef;--accent:#8a4f0c;
--wall:#8b867d;--floor:#eeebe4;--glass:#3f93c4;--yes:#1f6b3a;--no:#a3261b}
*{-webkit-print-color-adjust:exact;print-color-adjust:exact}
body{font-size:10pt}main,header,footer{max-width:none;padding:0}header{padding-top:0}nav{display:none}
section{margin:12mm 0 0;padding-top:6mm}
.room{break-before:page;margin-top:0;padding-top:0;border-top:0}section:last-of-type{break-inside:avoid}ul.list li{padding:1.2mm 0}.glance th,.glance td{padding-top:1mm;padding-bottom:1mm}.glance a{display:none}
.paper{display:block;margin:-3mm 0 5mm}.falsecolours+.room{break-before:auto;margin-top:12mm}.room>.lead{break-after:avoid}
h2,h3,caption,thead{break-after:avoid}figure,dl.figures,tr,ul.list,pre{break-inside:avoid}tbody{break-before:avoid}
thead{display:table-header-group;break-inside:avoid}tr.chosen th,tr.chosen td{background:none}.plan .sensors rect.chosen{stroke:none}.table{overflow:visible;margin:5mm 0}.short{break-inside:avoid}
footer,.filter,.fold,.switches,.readout,.exposure,.theme,.screen{display:none!important}
.first{grid-template-columns:1fr;gap:4mm}.views{margin-top:5mm}.views img{max-height:150mm;width:auto;max-width:100%}
.rest{display:block;margin-top:5mm}.rest figure{margin:5mm 0 0}.falsecolours,.falsecolours .rest figure{margin:0}.falsecolours summary{display:none}.falsecolours .rest{display:grid;grid-template-columns:1fr 1fr;gap:5mm}
figure{margin:5mm 0}figcaption{margin-top:2mm;font-size:8.6pt;max-width:none}.chart{max-width:128mm}tr.more{display:none}th[aria-sort] .sort::after{content:""}button.sort{display:contents!important}
table{font-size:8.6pt}th,td{padding:1.6mm 2mm 1.6mm 0}.n{padding-left:2mm;padding-right:0}
.n+th:not(.n),.n+td:not(.n){padding-left:4mm}tbody th:not(.n),tbody td:not(.n){min-width:4.6em}tbody th:not(.n){min-width:8.8em}tbody tr:nth-child(-n+2):not(:last-child){break-after:avoid}tbody tr:nth-last-child(-n+2):not(:first-child){break-before:avoid}
dl.figures{grid-template-columns:repeat(4,1fr);gap:3mm 6mm;margin:3mm 0}dl.figures dt{font-size:7.8pt}dl.figures dd{font-size:15pt}.glance dl.figures,.first .glance dl.figures{grid-template-columns:repeat(6,1fr);gap:3mm 4mm;margin:3mm 0}.glance p{margin:2mm 0 0;max-width:none}
svg.plan{max-height:112mm}h3{margin:5mm 0 2mm}a{text-decoration:none}}
)css";

}  // namespace clerestory
