"""World regions from nationalities as people write them; nothing is guessed."""

import pytest

from analysis.regions import (
    AMBIGUOUS_CODES,
    NOT_RECOGNISED,
    NOT_TOLD,
    SEVERAL,
    places,
    world_region,
)

REGIONS = {
    "Africa",
    "Asia",
    "Europe",
    "Latin America and the Caribbean",
    "Northern America",
    "Oceania",
}

# The member states of the United Nations and their regions of M49, as the data of the Python
# package country_converter 1.3.2 have them.
MEMBERS = {
    "Africa": "AGO BDI BEN BFA BWA CAF CIV CMR COD COG COM CPV DJI DZA EGY ERI ETH GAB GHA GIN GMB "
    "GNB GNQ KEN LBR LBY LSO MAR MDG MLI MOZ MRT MUS MWI NAM NER NGA RWA SDN SEN SLE SOM "
    "SSD STP SWZ SYC TCD TGO TUN TZA UGA ZAF ZMB ZWE",
    "Asia": "AFG ARE ARM AZE BGD BHR BRN BTN CHN CYP GEO IDN IND IRN IRQ ISR JOR JPN KAZ KGZ KHM "
    "KOR KWT LAO LBN LKA MDV MMR MNG MYS NPL OMN PAK PHL PRK QAT SAU SGP SYR THA TJK TKM "
    "TLS TUR UZB VNM YEM",
    "Europe": "ALB AND AUT BEL BGR BIH BLR CHE CZE DEU DNK ESP EST FIN FRA GBR GRC HRV HUN IRL ISL "
    "ITA LIE LTU LUX LVA MCO MDA MKD MLT MNE NLD NOR POL PRT ROU RUS SMR SRB SVK SVN SWE "
    "UKR",
    "Latin America and the Caribbean": "ARG ATG BHS BLZ BOL BRA "
    "BRB CHL COL CRI CUB DMA DOM ECU GRD GTM GUY HND HTI JAM KNA "
    "LCA MEX NIC PAN PER PRY SLV SUR TTO URY VCT VEN",
    "Northern America": "CAN USA",
    "Oceania": "AUS FJI FSM KIR MHL NRU NZL PLW PNG SLB TON TUV VUT WSM",
}


@pytest.mark.parametrize(
    ("told", "region"),
    [
        (told, region)
        for region, several in {
            "Europe": "Portuguese/Portugal/portuguese /PT/PRT/português/Portuguesa/PORTUGUES"
            "/British/UK/U.K./gb/English/Scottish/Deutsch/Español/espanola/italiana/polska/POLSKI/Français"
            "/Norsk/Österreich/Ελληνίδα/українець/Русская/Northern Irish/White British/European",
            "Northern America": "US/U.S.A./usa/American/Canadian/the United States of America"
            "/African American/African-American/Georgia USA",
            "Africa": "South African/South-African/RSA/Suid-Afrikaans/Nigerian/NIGERIA/Ivorian"
            "/Côte d'Ivoire/Cote d’Ivoire/Guinea-Bissau/African",
            "Asia": "Indian/I am Indian/Citizen of India/भारतीय/日本/한국/中国/Türk/turkish"
            "/Viet Nam/Kibris/azerbaycan/Georgia/Israeli/UAE",
            "Latin America and the Caribbean": "Mexican/mexicana/Brasileiro/Chilean/Trinidad and "
            "Tobago/Trinidad & Tobago/Latin American/West Indian/Puerto Rican",
            "Oceania": "Australian/aussie/NZ/New Zealander/Papua New Guinea/Fijian",
        }.items()
        for told in several.split("/")
    ],
)
def test_a_nationality_is_known_by_country_people_code_and_at_home(told, region):
    assert world_region(told) == region


@pytest.mark.parametrize(
    ("told", "region"),
    [
        ("Portuguese/Brazilian", SEVERAL),
        ("Portuguese and Brazilian", SEVERAL),
        ("Portuguesa e brasileira", SEVERAL),
        ("US and UK", SEVERAL),
        ("UK, PT, ZA", SEVERAL),
        ("Turkish-German", SEVERAL),
        ("half Italian half Japanese", SEVERAL),
        ("Irish/British", "Europe"),
        ("dual British & Irish", "Europe"),
        ("Georgia, USA", "Northern America"),
        ("Bosnia and Herzegovina", "Europe"),
    ],
)
def test_two_nationalities_are_several_if_their_regions_differ(told, region):
    assert world_region(told) == region


@pytest.mark.parametrize("told", [None, "", "  ", "prefer not to say", "Prefer not to say "])
def test_who_declines_has_not_told(told):
    assert world_region(told) == NOT_TOLD


NO_NATIONALITIES = """
Klingon; born in Portugal; Portuguese I think; n/a; na; no; SA; -; white; New Jersey; human;
North American; it is me in us; 42
"""


@pytest.mark.parametrize("told", [each.strip() for each in NO_NATIONALITIES.split(";")])
def test_what_is_not_understood_to_the_last_word_is_not_guessed(told):
    assert world_region(told) == NOT_RECOGNISED


def test_every_member_of_the_united_nations_is_listed_in_its_region_of_m49():
    listed = {row["alpha_3"]: row["region"] for row in places()}
    members = {code: region for region, codes in MEMBERS.items() for code in codes.split()}
    assert len(members) == 193
    assert {code: listed.get(code) for code in members} == members


def test_no_name_and_no_code_stands_for_two_regions():
    regions: dict[str, set[str]] = {}
    for row in places():
        names = (row["place"], *row["names"].split(";"), row["alpha_2"], row["alpha_3"])
        for name in {each.casefold() for each in names} - AMBIGUOUS_CODES - {""}:
            regions.setdefault(name, set()).add(row["region"])
    assert {name: found for name, found in regions.items() if len(found) > 1} == {}


def test_every_name_of_the_list_is_understood_by_itself_and_within_a_sentence():
    for row in places():
        for name in (row["place"], *filter(None, row["names"].split(";"))):
            assert world_region(name) == row["region"], name
            assert world_region(f" I am {name.upper()} ") == row["region"], name


def test_the_list_has_six_regions_and_each_place_once():
    rows = list(places())
    assert {row["region"] for row in rows} == REGIONS
    for key in ("place", "alpha_2", "alpha_3"):
        given = [row[key] for row in rows if row[key]]
        assert len(given) == len(set(given))
