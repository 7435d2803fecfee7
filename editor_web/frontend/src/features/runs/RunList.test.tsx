/** The runs of the server, at the side. */
import { screen } from '@testing-library/react'
import { expect, it } from 'vitest'
import { live, run, show } from '../../../testing/page'
import { RunList } from './RunList'

it('says that there are none only once the server has told so', async () => {
  show(<RunList current={undefined} href={(id) => `/runs/${id}`} onOpen={() => undefined} limit={5} />)
  expect(screen.queryByText('No runs yet')).toBeNull()
  live()
  expect(await screen.findByText('No runs yet')).toBeVisible()
})

it('tells runs apart that were started in the same second', async () => {
  live({ runs: [run({ id: 'r3', started_at_s: 10.99 }), run({ id: 'r2', started_at_s: 10.25 }), run({ id: 'r1', started_at_s: 8.5 })] })
  show(<RunList current={undefined} href={(id) => `/runs/${id}`} onOpen={() => undefined} limit={5} />)
  expect(await screen.findAllByRole('link')).toHaveLength(3)
  expect(screen.getByRole('link', { name: /:10\.99/ })).toHaveAttribute('href', '/runs/r3')
  expect(screen.getByRole('link', { name: /:10\.25/ })).toHaveAttribute('href', '/runs/r2')
  expect(screen.getByRole('link', { name: /:08 / })).toHaveAttribute('href', '/runs/r1')
})
