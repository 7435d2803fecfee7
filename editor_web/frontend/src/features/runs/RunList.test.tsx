/** The runs of the server, at the side. */
import { screen } from '@testing-library/react'
import { expect, it } from 'vitest'
import { live, show } from '../../../testing/page'
import { RunList } from './RunList'

it('says that there are none only once the server has told so', async () => {
  show(<RunList current={undefined} href={(id) => `/runs/${id}`} onOpen={() => undefined} limit={5} />)
  expect(screen.queryByText('No runs yet')).toBeNull()
  live()
  expect(await screen.findByText('No runs yet')).toBeVisible()
})
