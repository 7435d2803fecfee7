/** What is seen of the canvas may be on its way elsewhere: the canvas says that it is busy until it is there. */
import { pageStore } from '../../api/pageStore'

/** An animation that another one interrupts never says that it is over: none takes longer than this. */
const LONGEST_MS = 600

const useMoves = pageStore(() => ({ count: 0 }))

export const useIsMoving = () => useMoves((s) => s.count > 0)

/** The canvas is busy until this is done. */
export function trackViewportMotion(work: Promise<unknown>): void {
  count(1)
  void Promise.race([work, atTheLatest()]).finally(() => count(-1))
}

/** The canvas is busy until the next frame, for which this is kept; returns what takes it back. */
export function trackMotionNextFrame(work: () => Promise<unknown> | undefined): () => void {
  let end: (view?: Promise<unknown>) => void = () => undefined
  trackViewportMotion(new Promise<unknown>((done) => (end = done)))
  const frame = requestAnimationFrame(() => end(work()))
  return () => {
    cancelAnimationFrame(frame)
    end()
  }
}

function count(by: number): void {
  useMoves.setState((s) => ({ count: s.count + by }))
}

/** Two frames later than any animation: what is due at its end was drawn by then. */
function atTheLatest(): Promise<unknown> {
  return new Promise((done) => {
    setTimeout(() => requestAnimationFrame(() => requestAnimationFrame(done)), LONGEST_MS)
  })
}
