// Tells the page around the 3D view what it cannot hear, as the view is of another origin: that the mouse is down, again
// and again as long as it is, and the key of STOP. The page checks who says so.
(() => {
  if (window.parent === window) return
  const HELD_MS = 50
  const say = (what) => window.parent.postMessage({ cellView: what }, '*')
  let holding
  const letGo = () => {
    clearInterval(holding)
    holding = undefined
  }
  const hold = () => {
    letGo()
    say('held')
    holding = setInterval(() => say('held'), HELD_MS)
  }
  window.addEventListener('pointerdown', hold, { capture: true })
  for (const kind of ['pointerup', 'pointercancel', 'blur', 'pagehide']) window.addEventListener(kind, letGo, { capture: true })
  document.addEventListener('visibilitychange', () => document.hidden && letGo())
  const onKey = (event) => {
    if (event.key !== 'Backspace' || !event.ctrlKey || !event.shiftKey || event.altKey) return
    event.preventDefault()
    event.stopImmediatePropagation()
    if (!event.repeat) say('stop')
  }
  window.addEventListener('keydown', onKey, { capture: true })
})()
