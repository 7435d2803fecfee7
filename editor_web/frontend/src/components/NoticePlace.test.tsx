/** Notices that come and go: what the pointer is on stays where it is. */
import { act, fireEvent, screen } from '@testing-library/react'
import { beforeEach, expect, it, vi } from 'vitest'
import { show } from '../../testing/page'
import { NoticePlace } from './NoticePlace'

let heightPx = 0
let measure = () => {}

beforeEach(() => {
  heightPx = 0
  vi.spyOn(HTMLElement.prototype, 'offsetHeight', 'get').mockImplementation(() => heightPx)
  vi.stubGlobal(
    'ResizeObserver',
    class {
      constructor(onSize: () => void) {
        measure = onSize
      }
      observe(): void {}
      disconnect(): void {}
    },
  )
})

function page(): HTMLElement {
  show(
    <>
      <header>Head of all pages</header>
      <main>
        <NoticePlace>
          <p role="alert">The server does not answer</p>
        </NoticePlace>
        <button type="button">Open gripper</button>
      </main>
    </>,
  )
  return screen.getByRole('alert').parentElement?.parentElement?.parentElement as HTMLElement
}

function becomes(px: number): void {
  heightPx = px
  act(() => measure())
}

const content = () => screen.getByRole('button')

it('makes room for what comes while the pointer is elsewhere', () => {
  const place = page()
  becomes(60)
  expect(place).toHaveStyle({ height: '60px' })
  expect(place).not.toHaveAttribute('data-overlay')
  becomes(0)
  expect(place).toHaveStyle({ height: '0px' })
})

it('lies over the page while the pointer is on it, and takes its room when the pointer has left', () => {
  const place = page()
  fireEvent.pointerOver(content())
  becomes(60)
  expect(place).toHaveAttribute('data-overlay')
  expect(place).toHaveStyle({ height: '0px' })
  // On its way over the notice it is not away yet.
  fireEvent.pointerOver(screen.getByRole('alert'))
  expect(place).toHaveAttribute('data-overlay')
  fireEvent.pointerOver(screen.getByRole('banner'))
  expect(place).not.toHaveAttribute('data-overlay')
  expect(place).toHaveStyle({ height: '60px' })
})

it('leaves its room empty when it goes away under the pointer', () => {
  const place = page()
  becomes(60)
  fireEvent.pointerOver(content())
  becomes(0)
  expect(place).toHaveStyle({ height: '60px' })
  // A finger that is lifted is on nothing.
  fireEvent.pointerOut(content(), { relatedTarget: null })
  expect(place).toHaveStyle({ height: '0px' })
})
