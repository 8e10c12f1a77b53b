#pragma once
// What a debrief's page has beyond the report's look, and the script of its replay.

namespace calot::app {

inline constexpr const char* kDebriefStyle = R"css(
.head{display:flex;gap:32px;align-items:center;flex-wrap:wrap;margin-bottom:8px}
.ring{flex:none;width:148px;height:148px;position:relative}
.ring svg{width:148px;height:148px;transform:rotate(-90deg)}
.ring circle{fill:none;stroke-width:11}.ring .track{stroke:var(--line)}
.ring div{position:absolute;inset:0;display:flex;flex-direction:column;align-items:center;justify-content:center}
.ring b{font:600 44px/1 Georgia,serif}.ring span{color:var(--soft);font-size:13px;margin-top:3px}
.head .words{flex:1;min-width:300px}.head .words p{margin:0 0 6px}
.goal{font-weight:600}.facts{color:var(--soft);font-size:15px}
.broken p{max-width:none}.broken{background:color-mix(in srgb,var(--red) 12%,var(--card));border:1px solid color-mix(in srgb,var(--red) 40%,var(--line));border-radius:12px;padding:12px 18px;margin:16px 0}
.broken p{margin:3px 0}
.tips{list-style:none;padding:0;margin:0;display:grid;gap:10px;grid-template-columns:repeat(auto-fit,minmax(min(100%,320px),1fr))}
.tips li{background:var(--card);border:1px solid var(--line);border-radius:12px;padding:14px 16px}
.tips b{color:var(--warm);font:600 22px Georgia,serif;display:block;margin-bottom:2px}
.views{display:grid;grid-template-columns:1fr 1fr;gap:12px}.views figure{margin:0;position:relative}
.views img{width:100%;display:block;border-radius:12px;background:#000;aspect-ratio:4/3}
.views figcaption{position:absolute;left:12px;bottom:8px;color:#fff;font-size:13px;text-shadow:0 1px 3px #000;opacity:.85}
.player{display:flex;align-items:center;gap:14px;margin-top:12px}
.player button{flex:none;width:44px;height:44px;border-radius:50%;border:0;background:var(--ink);color:var(--paper);font-size:16px;cursor:pointer}
.player output{flex:none;min-width:66px;text-align:right;font-variant-numeric:tabular-nums}
.bar{flex:1;position:relative;padding-top:20px}.bar input{width:100%;margin:0;accent-color:var(--warm);display:block}
.bar .marks{position:absolute;left:8px;right:8px;top:0;height:20px}
.bar .marks a{position:absolute;width:10px;height:14px;margin-left:-5px;border-radius:3px;top:2px;cursor:pointer;background:var(--grey)}
.bar .marks i{position:absolute;top:16px;height:4px;background:var(--gold);border-radius:2px;opacity:.75}
.k-bad{background:var(--red)!important}.k-good{background:var(--green)!important}.k-touch{background:var(--blue)!important}
.events{max-height:240px;overflow:auto;border:1px solid var(--line);border-radius:12px;background:var(--card);padding:6px 0;margin-top:12px;columns:2 380px;column-gap:0}
.events a{display:flex;gap:12px;padding:3px 16px;color:inherit;text-decoration:none;cursor:pointer;break-inside:avoid}
.events a:hover{background:var(--shade)}.events time{width:62px;flex:none;text-align:right;color:var(--soft);font-variant-numeric:tabular-nums}
.events i{width:9px;height:9px;border-radius:50%;flex:none;background:var(--grey);align-self:center}
.go{margin-top:12px;color:var(--soft)}.go code{color:var(--ink);background:var(--card);border:1px solid var(--line);border-radius:6px;padding:3px 8px}
.maps{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(100%,420px),1fr));gap:14px}
.maps figure{margin:0;background:var(--card);border:1px solid var(--line);border-radius:12px;overflow:hidden}
.maps img{width:100%;display:block;background:#000}.maps figcaption{padding:10px 14px 12px}
.scale{display:flex;font-size:12px;color:var(--soft);margin-top:8px}.scale span{flex:1;text-align:center}
.scale i{display:block;height:9px;margin-bottom:3px}
.moments{display:grid;grid-template-columns:repeat(auto-fill,minmax(min(100%,220px),1fr));gap:12px}
.moments a{color:inherit;text-decoration:none;cursor:pointer}.moments img{width:100%;border-radius:10px;display:block;background:#000;aspect-ratio:4/3}
.moments span{font-size:14px;color:var(--soft);display:block;padding:4px 2px}
.parts{max-width:none}.parts td{vertical-align:middle}.parts .meter{width:22%;min-width:110px}
.parts .meter div{height:9px;border-radius:5px;background:var(--line);overflow:hidden}.parts .meter i{display:block;height:100%;background:var(--green)}
.parts td.number{text-align:right;white-space:nowrap}
details summary{cursor:pointer;color:var(--ink)}details p{color:var(--soft);font-size:14px;margin:4px 0 2px;max-width:60ch}
.all{max-width:none}.all td.number{white-space:nowrap}
@media (max-width:640px){.views{grid-template-columns:1fr}}
@media print{.player,.go,.events{display:none}}
)css";

inline constexpr const char* kDebriefScript = R"js(
(function(){
  var n=frames.length,slider=document.getElementById('at'),out=document.getElementById('now'),a=document.getElementById('front'),
      b=document.getElementById('side'),play=document.getElementById('play'),go=document.getElementById('from'),timer=null,k=0;
  function clock(t){var m=Math.floor(t/60),s=(t-60*m).toFixed(1);return m>0?m+':'+(s<10?'0':'')+s:s+' s'}
  function show(i){k=Math.max(0,Math.min(n-1,i));a.src=frames[k].a;b.src=frames[k].b;slider.value=k;out.textContent=clock(frames[k].t);
    if(go)go.textContent=frames[k].t.toFixed(1)}
  function near(t){var best=0;for(var i=0;i<n;i++)if(Math.abs(frames[i].t-t)<Math.abs(frames[best].t-t))best=i;return best}
  function stop(){if(timer){clearInterval(timer);timer=null;play.textContent='\u25B6';play.setAttribute('aria-label','play')}}
  function start(){if(k>=n-1)show(0);play.textContent='\u275A\u275A';play.setAttribute('aria-label','pause');
    timer=setInterval(function(){if(k>=n-1)stop();else show(k+1)},120)}
  slider.max=n-1;slider.addEventListener('input',function(){stop();show(+slider.value)});
  play.addEventListener('click',function(){timer?stop():start()});
  document.querySelectorAll('[data-t]').forEach(function(e){e.addEventListener('click',function(){stop();show(near(+e.dataset.t));
    if(e.closest('.moments'))document.getElementById('replay').scrollIntoView({behavior:'smooth'})})});
  document.querySelectorAll('.moments [data-t]').forEach(function(e){e.querySelector('img').src=frames[near(+e.dataset.t)].a});
  document.addEventListener('keydown',function(e){if(e.target.tagName==='INPUT')return;
    if(e.key==='ArrowRight'){stop();show(k+1);e.preventDefault()}if(e.key==='ArrowLeft'){stop();show(k-1);e.preventDefault()}});
  show(0);
})();
)js";

}  // namespace calot::app
