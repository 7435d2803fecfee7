/** A view that fails: what is said of it, and that it can be tried again. */
import { screen } from '@testing-library/react'
import { afterEach, beforeEach, expect, it, vi } from 'vitest'
import { show } from '../../testing/page'
import { lazyView } from './lazyView'
import { ViewBoundary } from './ViewBoundary'

let isBroken = true

function Chart() {
  if (isBroken) throw new TypeError('no axis')
  return <p>drawn</p>
}

// React reports every failure to the console as well.
beforeEach(() => {
  isBroken = true
  vi.spyOn(console, 'error').mockImplementation(() => undefined)
})
afterEach(() => vi.restoreAllMocks())

it('leaves the others alone, says what failed, and shows it once it is whole', async () => {
  const user = show(
    <>
      <ViewBoundary name="Plots">
        <Chart />
      </ViewBoundary>
      <p>the log</p>
    </>,
  )
  expect(screen.getByText('the log')).toBeVisible()
  const failure = screen.getByRole('alert', { name: 'Failure of Plots' })
  expect(failure).toHaveTextContent('Plots cannot be shown')
  expect(failure).toHaveTextContent('TypeError: no axis')
  await user.click(screen.getByRole('button', { name: 'Try again' }))
  expect(screen.getByRole('alert')).toBeVisible()
  isBroken = false
  await user.click(screen.getByRole('button', { name: 'Try again' }))
  expect(screen.getByText('drawn')).toBeVisible()
  expect(screen.queryByRole('alert')).toBeNull()
})

it('hands out the details of the failure', async () => {
  const user = show(
    <ViewBoundary name="Plots">
      <Chart />
    </ViewBoundary>,
  )
  await user.click(screen.getByRole('button', { name: 'Copy details' }))
  expect(await screen.findByRole('button', { name: 'Copied' })).toBeVisible()
  const details = await navigator.clipboard.readText()
  expect(details).toContain('Plots at ')
  expect(details).toContain('TypeError: no axis')
  expect(details).toContain('at Chart')
})

it('shows the details where they cannot be copied', async () => {
  const user = show(
    <ViewBoundary name="Plots">
      <Chart />
    </ViewBoundary>,
  )
  vi.spyOn(navigator.clipboard, 'writeText').mockRejectedValue(new Error('not allowed'))
  await user.click(screen.getByRole('button', { name: 'Copy details' }))
  expect(await screen.findByText(/^Plots at/)).toBeVisible()
})

it.each([
  ['loads the page anew where code does not come again and the server answers', true, 1],
  ['stays where the server does not answer either', false, 0],
])('%s', async (_, isThere, reloads) => {
  const reload = vi.spyOn(location, 'reload').mockImplementation(() => undefined)
  vi.stubGlobal('fetch', () => (isThere ? Promise.resolve(new Response('')) : Promise.reject(new TypeError('Failed to fetch'))))
  const Lazy = lazyView(() => Promise.reject(new TypeError('Failed to fetch dynamically imported module')))
  const user = show(
    <ViewBoundary name="Plots">
      <Lazy />
    </ViewBoundary>,
  )
  await user.click(await screen.findByRole('button', { name: 'Try again' }))
  expect(await screen.findByRole('alert')).toHaveTextContent('Failed to fetch dynamically imported module')
  expect(reload).toHaveBeenCalledTimes(reloads)
})
