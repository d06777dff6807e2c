//! Who is connected and who follows what.

use std::collections::BTreeMap;

use rvac_api::Topic;

use crate::ClientId;

const fn bit(topic: Topic) -> u16 {
    match topic {
        Topic::Status => 1,
        Topic::Pose => 2,
        Topic::Device => 4,
        Topic::Map => 8,
        Topic::Log => 16,
        Topic::Packets => 32,
        Topic::Home => 64,
        Topic::Estimate => 128,
        Topic::PlannedPath => 256,
        Topic::Decisions => 512,
        Topic::Schedules => 1024,
        Topic::Runs => 2048,
        Topic::Floors => 4096,
        Topic::Standstills => 8192,
        Topic::Buttons => 16_384,
        Topic::Inputs => 32_768,
    }
}

#[derive(Debug, Default)]
struct Client {
    name: String,
    topics: u16,
}

/// The connected clients.
#[derive(Debug, Default)]
pub(crate) struct Clients {
    clients: BTreeMap<ClientId, Client>,
    /// Topics that anybody follows.
    followed: u16,
}

impl Clients {
    pub(crate) fn connect(&mut self, client: ClientId) {
        self.clients.insert(
            client,
            Client {
                name: format!("client-{}", client.0),
                topics: 0,
            },
        );
    }

    pub(crate) fn forget(&mut self, client: ClientId) {
        self.clients.remove(&client);
        self.count();
    }

    pub(crate) fn rename(&mut self, client: ClientId, name: String) {
        if let Some(entry) = self.clients.get_mut(&client) {
            entry.name = name;
        }
    }

    /// Name for people; a number for one that never introduced itself.
    pub(crate) fn name(&self, client: ClientId) -> String {
        self.clients
            .get(&client)
            .map_or_else(|| format!("client-{}", client.0), |entry| entry.name.clone())
    }

    /// Replaces the topics of a client; gives those that it did not follow before, in the order in which it names them.
    pub(crate) fn watch(&mut self, client: ClientId, topics: &[Topic]) -> Vec<Topic> {
        let Some(entry) = self.clients.get_mut(&client) else {
            return Vec::new();
        };
        let mut known = entry.topics;
        entry.topics = topics.iter().fold(0, |all, topic| all | bit(*topic));
        self.count();
        let mut new = Vec::new();
        for topic in topics {
            if known & bit(*topic) == 0 {
                known |= bit(*topic);
                new.push(*topic);
            }
        }
        new
    }

    /// Whether anybody follows `topic`.
    pub(crate) fn any(&self, topic: Topic) -> bool {
        self.followed & bit(topic) != 0
    }

    /// Whether anybody follows anything.
    pub(crate) fn any_topic(&self) -> bool {
        self.followed != 0
    }

    pub(crate) fn followers(&self, topic: Topic) -> impl Iterator<Item = ClientId> + '_ {
        let wanted = bit(topic);
        self.clients
            .iter()
            .filter(move |(_, entry)| entry.topics & wanted != 0)
            .map(|(client, _)| *client)
    }

    fn count(&mut self) {
        self.followed = self.clients.values().fold(0, |all, entry| all | entry.topics);
    }
}

#[cfg(test)]
mod tests {
    use rvac_api::Topic;

    use super::Clients;
    use crate::ClientId;

    #[test]
    fn watching_replaces_and_tells_what_is_new() {
        let mut clients = Clients::default();
        clients.connect(ClientId(7));
        clients.connect(ClientId(3));
        assert_eq!(
            clients.watch(ClientId(7), &[Topic::Map, Topic::Log]),
            [Topic::Map, Topic::Log]
        );
        assert_eq!(clients.watch(ClientId(3), &[Topic::Log]), [Topic::Log]);
        assert_eq!(
            clients.followers(Topic::Log).collect::<Vec<_>>(),
            [ClientId(3), ClientId(7)]
        );
        assert_eq!(
            clients.watch(
                ClientId(7),
                &[Topic::Log, Topic::PlannedPath, Topic::Pose, Topic::PlannedPath]
            ),
            [Topic::PlannedPath, Topic::Pose],
            "each once, in the order in which it was asked for"
        );
        assert!(!clients.any(Topic::Map) && clients.any(Topic::Pose));
        clients.forget(ClientId(7));
        assert!(!clients.any(Topic::Pose) && clients.any_topic());
    }
}
