/** What every component test begins with and leaves behind: its matchers, what the DOM here lacks, a page of nothing. */
import '@testing-library/jest-dom/vitest'
import { cleanup, configure } from '@testing-library/react'
import { afterEach, beforeEach, expect, vi } from 'vitest'
import { forgetPage, newServer, server } from './page.tsx'

// A page that never does it still fails; how long it takes depends on what else the machine does.
configure({ asyncUtilTimeout: 15_000 })

/** The layout is not computed here: everything is as large as a screen, and in sight. */
const SCREEN = { x: 0, y: 0, top: 0, left: 0, right: 1280, bottom: 800, width: 1280, height: 800 }

class Observer {
  constructor(private readonly onSeen: (entries: readonly object[]) => void) {}

  observe(target: Element): void {
    this.onSeen([
      { target, isIntersecting: true, intersectionRatio: 1, contentRect: SCREEN, borderBoxSize: [{ inlineSize: 1280, blockSize: 800 }] },
    ])
  }

  unobserve(): void {}
  disconnect(): void {}
}
vi.stubGlobal('ResizeObserver', Observer)
vi.stubGlobal('IntersectionObserver', Observer)
Object.defineProperty(navigator, 'getGamepads', { configurable: true, value: () => [] })
Object.defineProperty(document, 'fonts', { configurable: true, value: new EventTarget() })
Element.prototype.scrollIntoView = () => undefined
Element.prototype.setPointerCapture = () => undefined
Element.prototype.releasePointerCapture = () => undefined
Object.defineProperty(window, 'matchMedia', {
  configurable: true,
  value: (media: string) => ({
    media,
    matches: false,
    addEventListener: () => undefined,
    removeEventListener: () => undefined,
    addListener: () => undefined,
    removeListener: () => undefined,
  }),
})
beforeEach(newServer)
afterEach(() => {
  cleanup()
  forgetPage()
  // oxlint-disable-next-line vitest/no-standalone-expect -- of each test
  expect(server().unanswered).toEqual([])
})
