/** What the programs of the page take for granted and a bare JavaScript engine lacks; it has promises, and nothing else that waits. */

type Task = () => void

interface Port {
  onmessage?: (event: object) => void
}

/** Time means nothing to a drawing: what is put off comes next. */
function later(task: Task): number {
  void Promise.resolve().then(task)
  return 0
}

/** Of its messages only that they come is asked for. */
class Channel {
  readonly port1: Port = {}
  readonly port2 = { postMessage: () => later(() => this.port1.onmessage?.({})) }
}

class Encoder {
  encode(text: string): Uint8Array {
    return Uint8Array.from(unescape(encodeURIComponent(text)), (letter) => letter.charCodeAt(0))
  }
}

const silent = () => undefined
const globals = new Map<string, unknown>([
  ['self', globalThis],
  ['setTimeout', later],
  ['clearTimeout', silent],
  ['MessageChannel', Channel],
  ['TextEncoder', Encoder],
  ['console', { log: silent, warn: silent, error: silent, info: silent, debug: silent }],
])

/** What was lacking here, and is there from now on. */
export const supplied: readonly string[] = [...globals.keys()].filter((name) => !(name in globalThis))
for (const name of supplied) Object.assign(globalThis, { [name]: globals.get(name) })
