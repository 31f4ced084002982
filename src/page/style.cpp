#include "page/page.h"

namespace calot {

// Text has a contrast of at least 4.5 to 1 with its ground in light and dark; what matters is told by shape and words too.
const char* page_style() {
  return R"(
:root{color-scheme:light dark;--bg:#fff;--fg:#1a1f24;--soft:#4f5963;--line:#cfd6dc;--card:#f4f6f8;--link:#0b56a4;
--bad:#b3261e;--good:#1b6b35;--mark:#fff3c4;--c0:#1b6ca8;--c1:#b8431f;--c2:#7a5c00;--c3:#256b50;--c4:#5b4fa0}
@media (prefers-color-scheme:dark){:root{--bg:#14181c;--fg:#e8ebee;--soft:#a9b3bd;--line:#3a444e;--card:#1d2329;
--link:#86bdf3;--bad:#ff8f85;--good:#7fdc97;--mark:#4a3f10;--c0:#6cb2ee;--c1:#ff9a7a;--c2:#e0bf4a;--c3:#77c9a5;--c4:#b8adf5}}
*{box-sizing:border-box}
html{scroll-padding-top:1rem}
body{margin:0 auto;padding:1rem;max-width:76rem;background:var(--bg);color:var(--fg);font:1rem/1.5 system-ui,sans-serif}
h1,h2,h3,h4{line-height:1.25;margin:1.4em 0 .5em;overflow-wrap:anywhere}
h1{font-size:1.7rem;margin-top:0}h2{font-size:1.4rem}h3{font-size:1.15rem}h4{font-size:1rem;margin:0}
p{margin:.4em 0;overflow-wrap:anywhere}
header>p:first-child{margin:0}
main>section{border-top:3px solid var(--line);margin-top:1.5rem}
main>section>h2{margin-top:.8rem}
a{color:var(--link)}
:focus-visible{outline:3px solid var(--link);outline-offset:2px}
main:focus{outline:none}
.skip{position:absolute;left:-100rem}.skip:focus{left:1rem;top:.5rem;background:var(--bg);padding:.5rem;z-index:1}
nav ul,.legend{list-style:none;margin:.5rem 0;padding:0;display:flex;flex-wrap:wrap;gap:.3rem 1.2rem}
nav a{display:inline-block;padding:.35rem 0;overflow-wrap:anywhere}
.soft{color:var(--soft)}.soft,.legend,figcaption{font-size:.9rem}.path{overflow-wrap:anywhere}
.good{color:var(--good)}.bad{color:var(--bad)}
.total{font-size:1.15rem}.total>b{font-size:2.4rem;line-height:1}.total>span{margin-left:.6rem;font-weight:600}
.warning{border-left:5px solid var(--bad);background:var(--card);padding:.5rem .8rem}
.cards{list-style:none;margin:0;padding:0;display:grid;gap:.8rem;grid-template-columns:repeat(auto-fit,minmax(min(17rem,100%),1fr))}
.cards>li{background:var(--card);border:1px solid var(--line);border-radius:6px;padding:.8rem}
.cards svg{max-width:22rem;margin-top:.3rem}
.pictures,.plots{display:grid;gap:1rem;grid-template-columns:repeat(auto-fill,minmax(min(21rem,100%),1fr))}
figure{margin:0;break-inside:avoid;min-width:0}
img{width:100%;height:auto;display:block;border-radius:4px}
svg{display:block;width:100%;height:auto}
.wide{overflow-x:auto;margin:.5rem 0}.drawing>svg{min-width:40rem}
table{border-collapse:collapse;min-width:min(100%,24rem);font-variant-numeric:tabular-nums}
caption{text-align:left;color:var(--soft);font-size:.9rem;padding:.2rem 0}
th,td{text-align:left;padding:.3rem .7rem;border-bottom:1px solid var(--line);vertical-align:top;font-weight:400}
thead th{font-weight:600}th:first-child,td:first-child{padding-left:.4rem}.n{text-align:right}
td a,td.n,th.n[scope=row]{white-space:nowrap}
.overview thead th{max-width:9rem;vertical-align:bottom}.overview th:nth-child(n+6){min-width:4rem}.overview th,.overview td{padding:.3rem .38rem}
.overview .verdict{display:inline-block;min-width:9rem;max-width:24rem;overflow-wrap:anywhere}
.sum td,.sum th{background:var(--card)}
tr:target,figure:target{background:var(--mark)}
figure:target{box-shadow:0 0 0 6px var(--mark)}
.error-row>th,.error-row>td:nth-child(2){border-left:4px solid var(--bad)}.error-row>td:nth-child(2){border-left:0}
summary{cursor:pointer;padding:.3rem 0}
.key{display:inline-block;width:1.9rem;margin-right:.4rem}
svg text{font:12px system-ui,sans-serif;fill:var(--fg)}
svg .mid{text-anchor:middle}svg .end{text-anchor:end}
.grid{stroke:var(--line);fill:none}.axis{stroke:var(--fg)}.track{stroke:var(--line);stroke-width:5}
.measured{fill:var(--c0)}.begin{stroke:var(--bg)}
.curve{fill:none;stroke-width:1.6;stroke-linejoin:round}
.c0{stroke:var(--c0)}.c1{stroke:var(--c1);stroke-dasharray:6 2}.c2{stroke:var(--c2);stroke-dasharray:2 2}
.c3{stroke:var(--c3);stroke-dasharray:8 3 2 3}.c4{stroke:var(--c4);stroke-dasharray:4 4}
.begin.c0{fill:var(--c0)}.begin.c1{fill:var(--c1)}.begin.c2{fill:var(--c2)}.begin.c3{fill:var(--c3)}.begin.c4{fill:var(--c4)}
.begin{stroke-dasharray:none}
.band{fill:var(--good);fill-opacity:.18;stroke:none}.key .band{stroke:var(--good);stroke-opacity:.3;stroke-width:9}.level{stroke:var(--bad);stroke-dasharray:8 4;fill:none}.step{stroke:var(--soft);stroke-dasharray:1 3;fill:none}
.error{stroke:var(--bad);fill:none;opacity:.8}
.bar{fill:var(--card);stroke:var(--soft)}.bar.bad{stroke:var(--bad);stroke-width:2}
.error-mark{fill:var(--bad)}.mark{fill:var(--bg);stroke:var(--fg);stroke-width:1.5}
a:target .mark,a:target .error-mark{stroke:var(--link);stroke-width:4}
.disc{fill:var(--c0);stroke:var(--c0);stroke-width:2}.ring{fill:var(--bg);stroke:var(--c1);stroke-width:2.5}
.ring.cut{stroke-dasharray:3 2}.cross{stroke:var(--c1);stroke-width:3}.narrow{max-width:34rem}caption>span{display:block;max-width:calc(100vw - 3rem)}
@media (max-width:48rem){.overview thead{display:none}.overview table,.overview tbody,.overview tr{display:block}
.overview tr{border-top:2px solid var(--line);padding:.4rem 0}.overview caption,.overview th[scope=row]{display:block;text-align:left}
.overview td{display:flex;justify-content:space-between;gap:1rem;border:0;min-width:0!important;max-width:none!important;text-align:right}
.overview td::before{content:attr(data-label);color:var(--soft);text-align:left;overflow-wrap:anywhere;min-width:5rem}
.overview .verdict{min-width:0}.overview td:empty{display:none}
}
@media print{nav,.skip{display:none}body{max-width:none;padding:0}.wide{overflow:visible}}
)";
}

}  // namespace calot
