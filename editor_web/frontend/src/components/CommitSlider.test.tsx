/** A slider whose value counts when it is let go. */
import { fireEvent, screen, waitFor } from '@testing-library/react'
import { expect, it, vi } from 'vitest'
import { show } from '../../testing/page'
import { CommitSlider } from './CommitSlider'

const commit = vi.fn<(value: number) => Promise<boolean>>()

function Speed({ value = 100 }: { readonly value?: number }) {
  return <CommitSlider label="Speed" min={5} max={100} step={5} value={value} words={(percent) => `${percent} %`} onCommit={commit} />
}

function slid(to: number): HTMLElement {
  const slider = screen.getByLabelText('Speed')
  fireEvent.change(slider, { target: { value: String(to) } })
  return slider
}

it.each(['pointerUp', 'keyUp', 'blur'] as const)('sends its value at %s, once', (event) => {
  commit.mockReset().mockResolvedValue(true)
  show(<Speed />)
  const slider = slid(85)
  expect(commit).not.toHaveBeenCalled()
  expect(slider).toHaveAttribute('aria-valuetext', '85 %')
  fireEvent[event](slider)
  fireEvent[event](slider)
  expect(screen.getByRole('status')).toHaveTextContent('85 %')
  return waitFor(() => expect(commit.mock.calls).toEqual([[85]]))
})

it('goes back when the server refuses', async () => {
  commit.mockReset().mockResolvedValue(false)
  show(<Speed />)
  fireEvent.pointerUp(slid(5))
  await waitFor(() => expect(screen.getByLabelText('Speed')).toHaveAttribute('aria-valuetext', '100 %'))
})

it('sends one value after the other, so that the last one holds', async () => {
  const answers: ((taken: boolean) => void)[] = []
  commit.mockReset().mockImplementation(() => new Promise((resolve) => answers.push(resolve)))
  show(<Speed />)
  fireEvent.keyUp(slid(95))
  fireEvent.keyUp(slid(90))
  await waitFor(() => expect(commit.mock.calls).toEqual([[95]]))
  answers[0]?.(true)
  await waitFor(() => expect(commit.mock.calls).toEqual([[95], [90]]))
  answers[1]?.(true)
})
