"""What is measured inside of the browser: scripts that drive the page frame by frame and read its clocks."""

PROBE = """
(() => {
  const probe = (globalThis.probe = { tasks: [], keys: [], seq: 0, run: '' })
  new PerformanceObserver((list) => {
    for (const each of list.getEntries()) probe.tasks.push([each.startTime, each.duration])
  }).observe({ type: 'longtask', buffered: true })
  const frame = () => new Promise((resolve) => requestAnimationFrame(resolve))
  addEventListener('keydown', async () => {
    const begun = performance.now()
    await frame(); await new Promise((done) => setTimeout(done))
    probe.keys.push(performance.now() - begun)
  }, { capture: true })
  const at = (x, y, buttons) =>
    ({ bubbles: true, cancelable: true, view: window, clientX: x, clientY: y, button: 0, buttons })
  const mouse = (name, x, y, buttons) => new MouseEvent(name, at(x, y, buttons))

  // Holds what is at a place and moves it each frame, to and fro; frames a second and the longest frame.
  probe.drag = async (selector, place, seconds) => {
    const target = document.querySelector(selector)
    const box = target.getBoundingClientRect()
    const x0 = place ? place[0] : box.left + box.width / 2
    const y0 = place ? place[1] : box.top + 14
    target.dispatchEvent(new PointerEvent('pointerdown', { ...at(x0, y0, 1), pointerId: 1, isPrimary: true }))
    target.dispatchEvent(mouse('mousedown', x0, y0, 1))
    for (let i = 1; i < 4; i += 1) { window.dispatchEvent(mouse('mousemove', x0 + 3 * i, y0, 1)); await frame() }
    const start = performance.now()
    let frames = 0, last = start, longest = 0
    while (last - start < seconds * 1000) {
      const angle = (last - start) / 250
      window.dispatchEvent(mouse('mousemove', x0 + 70 * Math.sin(angle), y0 + 45 * Math.sin(angle / 2), 1))
      await frame()
      const now = performance.now()
      longest = Math.max(longest, now - last)
      last = now
      frames += 1
    }
    window.dispatchEvent(mouse('mousemove', x0, y0, 1))
    window.dispatchEvent(mouse('mouseup', x0, y0, 0))
    return { fps: (frames * 1000) / (last - start), frames, longest }
  }

  // From a key until something is there and painted.
  probe.until = (event, isThere) => new Promise((resolve) => {
    let begun = 0
    addEventListener(event, () => { begun ||= performance.now() }, { capture: true, once: true })
    const look = async () => {
      if (!begun || !isThere()) return
      watch.disconnect()
      await frame(); await new Promise((done) => setTimeout(done))
      resolve(performance.now() - begun)
    }
    const watch = new MutationObserver(look)
    watch.observe(document, { subtree: true, childList: true, attributes: true, characterData: true })
  })

  // The page's end of the live stream, to be fed by hand.
  const Real = globalThis.WebSocket
  globalThis.WebSocket = class extends Real {
    constructor(...given) { super(...given); probe.socket = this }
    set onmessage(handler) {
      probe.handler = handler
      super.onmessage = (message) => {
        const frame = JSON.parse(message.data)
        if (frame.k === 'snapshot' || frame.k === 'delta') { probe.seq = frame.seq; probe.run = frame.run }
        if (!probe.isFed || frame.k === 'ping') handler(message)
      }
    }
    get onmessage() { return super.onmessage }
  }
  // Twenty nodes change with each frame of the stream; the script time until React has drawn them.
  const IDLE = { outcome: null, entered_s: 0, duration_s: 1, last_transition: null, cause: '' }
  const QUIET = { k: 'delta', ticking: true, runs: [], log: [], dropped: 0, control: null, robots: {} }
  probe.overlay = async (paths, times) => {
    probe.isFed = true
    const spent = []
    for (let i = 0; i < times; i += 1) {
      const nodes = {}
      for (let j = 0; j < 20; j += 1) {
        const path = paths[(i * 20 + j) % paths.length]
        const isOver = i % 2 === 1
        nodes[path] = { ...IDLE, status: isOver ? 'done' : 'active', outcome: isOver ? 'done' : null, visits: i }
      }
      const { run, seq: after } = probe
      probe.seq += 1
      const data = JSON.stringify({ ...QUIET, run, after, seq: probe.seq, now_s: i, nodes })
      const message = new MessageEvent('message', { data })
      performance.mark('overlay-begin')
      probe.handler(message)
      const { port1, port2 } = new MessageChannel()
      await new Promise((done) => { port1.onmessage = done; port2.postMessage(0) })
      spent.push(performance.measure('overlay', 'overlay-begin').duration)
      await frame(); await new Promise((done) => setTimeout(done, 40))
    }
    probe.isFed = false
    return spent
  }
})()
"""
