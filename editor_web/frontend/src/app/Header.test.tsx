/** The bar on top: where one is, whether it is live, and which run its stop button is for. */
import { screen, waitFor } from '@testing-library/react'
import { expect, it, vi } from 'vitest'
import { live, run, server, show } from '../../testing/page'
import { Header, type HeaderProps } from './Header'

const NAP = run({ id: 'r1', behavior: 'behaviors/nap.yaml' })
const SHIFT = run({ id: 'r2', behavior: 'behaviors/shift.yaml' })
const NIGHT = run({ id: 'r3', behavior: 'behaviors/night.yaml' })
const led = vi.fn<(where: string) => void>()

function Bar(told: Partial<HeaderProps>) {
  return (
    <Header
      cellName="bench"
      devices=""
      isKnown
      mayOperate
      shown={undefined}
      active={[]}
      onHome={() => led('home')}
      isCell={false}
      onCell={vi.fn()}
      isTeaching={false}
      onTeach={() => led('teach')}
      onRun={led}
      onRuns={() => led('runs')}
      {...told}
    />
  )
}

it('stops the run of the page, and counts the others', async () => {
  led.mockReset()
  server().on('POST /runs/r1/stop', {})
  live({ runs: [NAP, SHIFT, NIGHT] })
  const user = show(<Bar shown={NAP} active={[NAP, SHIFT, NIGHT]} />)
  await user.click(screen.getByRole('button', { name: 'Stop this run' }))
  await waitFor(() => expect(server().bodies('POST /runs/r1/stop')).toEqual([{ reason: 'stopped in the dashboard' }]))
  await user.click(screen.getByRole('link', { name: /\+ 2 others/ }))
  await user.click(screen.getByRole('button', { name: 'nap' }))
  expect(led.mock.calls).toEqual([['runs'], ['r1']])
})

it('stops the only run from any page', () => {
  live({ runs: [NAP] })
  show(<Bar active={[NAP]} />)
  expect(screen.getByRole('button', { name: 'nap' })).toBeVisible()
  expect(screen.getByRole('button', { name: 'Stop this run' })).toBeEnabled()
})

it('stops none of several that the page does not show, and leads to them', async () => {
  led.mockReset()
  live({ runs: [NAP, SHIFT] })
  const user = show(<Bar active={[NAP, SHIFT]} />)
  expect(screen.queryByRole('button', { name: 'Stop this run' })).toBeNull()
  await user.click(screen.getByRole('link', { name: '2 runs active' }))
  expect(led.mock.calls).toEqual([['runs']])
})

it('has no stop button for a viewer, nor one that works without a server', () => {
  const socket = live({ runs: [NAP] })
  show(
    <>
      <Bar active={[NAP]} />
      <Bar active={[NAP]} mayOperate={false} />
    </>,
  )
  expect(screen.getAllByRole('button', { name: 'Stop this run' })).toHaveLength(1)
  socket.cut()
  expect(screen.getByRole('button', { name: 'Stop this run' })).toBeDisabled()
})

it('says whether the page is live', () => {
  const socket = live()
  show(<Bar />)
  expect(screen.getByRole('status')).toHaveTextContent('Live')
  socket.cut()
  expect(screen.getByRole('status')).toHaveTextContent('Reconnecting')
})

it('changes the theme, and leads home and to teaching', async () => {
  led.mockReset()
  live()
  const user = show(<Bar />)
  await user.click(screen.getByRole('button', { name: 'Use the dark theme' }))
  expect(document.documentElement).toHaveAttribute('data-mantine-color-scheme', 'dark')
  await user.click(screen.getByRole('button', { name: 'Use the light theme' }))
  expect(document.documentElement).toHaveAttribute('data-mantine-color-scheme', 'light')
  await user.click(screen.getByRole('link', { name: 'flexcell' }))
  await user.click(screen.getByRole('link', { name: 'Teach' }))
  expect(led.mock.calls).toEqual([['home'], ['teach']])
})
